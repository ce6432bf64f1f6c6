#pragma once

#include <span>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/map/map_information.h"

namespace paloc {

/// A patch of the map's surface that a scan lies on, in the body frame.
struct SurfacePatch {
  Vec6 gradient = Vec6::Zero();  ///< Y of sharedSpread(), tangent of PlaneRow
  Vec3 normal = Vec3::Zero();    ///< unit, of its points' mean
  Vec3 point = Vec3::Zero();     ///< their centroid (m)
};

/// The patches that rows lie on (assignPatches()), in the order of their numbers; normal and point
/// are weighted like the gradient.
PALOC_EXPORT std::vector<SurfacePatch> surfacePatches(std::span<const PlaneRow> rows);

/// Leaves of them those whose shift, of standard deviation `plane_bias_m`, matters to the pose: in
/// units of its covariance, of which each patch has the part S Y^T (H + G S G^T)^-1 Y of six, at
/// least a thousandth. `information` is that of leastSquares(), `spread` that of sharedSpread().
PALOC_EXPORT void keepWhatMatters(const Mat6& information, const Mat6& spread, double plane_bias_m,
                                  std::vector<SurfacePatch>& patches);

}  // namespace paloc
