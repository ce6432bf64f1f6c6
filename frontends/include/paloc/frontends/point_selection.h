#pragma once

#include <cstdint>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/lidar_frame.h"
#include "paloc/frontends/measured_point.h"
#include "paloc/map/scan_thinning.h"

namespace paloc {

/// The points of a scan as they were measured: those within range, spread evenly over the surfaces.
class PALOC_EXPORT PointSelection {
 public:
  explicit PointSelection(const FrontendSettings& settings) : settings_(settings) {}

  /// About `wanted` of the points with the given indices, at most; of all where these are null.
  void select(const LidarFrame& frame, bool has_times, std::size_t wanted,
              const std::vector<std::uint32_t>* indices, std::vector<MeasuredPoint>& selected);
  /// All the points with the given indices.
  void selectAll(const LidarFrame& frame, bool has_times, const std::vector<std::uint32_t>& indices,
                 std::vector<MeasuredPoint>& selected);

 private:
  void add(const LidarFrame& frame, bool has_times, std::uint32_t index,
           std::vector<MeasuredPoint>& selected) const;

  FrontendSettings settings_;
  ScanThinning thinning_;
  std::vector<Point3f> candidates_;
};

/// Every stepOf()-th of the points, the first included, so that about `wanted` are left.
PALOC_EXPORT std::size_t stepOf(std::size_t points, std::size_t wanted);
PALOC_EXPORT std::vector<MeasuredPoint> everyNth(const std::vector<MeasuredPoint>& points,
                                                 std::size_t wanted);

}  // namespace paloc
