#pragma once

#include <span>
#include <vector>

#include "paloc/map/map_information.h"
#include "paloc/map/surface_patches.h"

namespace paloc {

/// Sums over the rows of one patch, each by its weight, one over its variance.
struct PatchSums {
  Vec6 gradient = Vec6::Zero();  // Y of sharedSpread()
  Vec3 normal = Vec3::Zero(), point = Vec3::Zero();
  double weight = 0, residual = 0;
};

/// What the errors that rows share act on.
struct RowSums {
  std::vector<PatchSums> patches;  // by their numbers
  Vec6 range = Vec6::Zero();       // y of sharedSpread()
};

RowSums sumsOf(std::span<const PlaneRow> rows);

/// sharedSpread() of these rows.
Mat6 spreadOf(const RowSums& sums, const SharedErrors& shared);

/// surfacePatches() of these rows.
std::vector<SurfacePatch> surfacePatches(const RowSums& sums);

}  // namespace paloc
