#include "paloc/frontends/map_scale_check.h"

#include <algorithm>
#include <vector>

#include "paloc/core/text.h"
#include "paloc/map/voxel_filter.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

// Of all but the outermost fiftieth on each side: a stray point must not make a map large.
double extentAlong(const PointCloud& map, float Point3f::*axis) {
  std::vector<float> values;
  values.reserve(map.size());
  for (const Point3f& p : map.points) values.push_back(p.*axis);
  const auto at = [&](std::size_t index) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(index);
    std::nth_element(values.begin(), place, values.end());
    return static_cast<double>(*place);
  };
  const std::size_t cut = values.size() / 50;
  const double low = at(cut);
  return at(values.size() - 1 - cut) - low;
}

}  // namespace

Findings checkMapScale(const PointCloud& map, const std::string& name, double scan_reach_m) {
  constexpr double kSparse = 1.5;  // points in a cubic metre that has any: no surface can be fitted
  constexpr double kFarther = 50;  // than the scans reach; a campus is
  constexpr double kTooSmall = 0.3;  // of what a single scan sees
  if (map.empty() || !(scan_reach_m > 0)) return {};
  const double x = extentAlong(map, &Point3f::x), y = extentAlong(map, &Point3f::y),
               z = extentAlong(map, &Point3f::z);
  const double extent = std::max({x, y, z});
  const auto cells = static_cast<double>(VoxelFilter().select(map.points, 1.0).size());
  const double density = static_cast<double>(map.size()) / cells;
  Finding finding;
  finding.check = "map-scale";
  finding.severity = Severity::kError;
  finding.label = name;
  finding.value = extent;
  finding.unit = "m";
  const std::string spans = text("the map ", name, " spans ", figure("%.4g", x), " x ",
                                 figure("%.4g", y), " x ", figure("%.4g", z), " m");
  const std::string reach = text("the scans reach ", figure("%.3g", scan_reach_m), " m");
  if (extent > kFarther * scan_reach_m && density < kSparse) {
    finding.sentence =
        text(spans, " with ", figure("%.2g", density), " points in a cubic metre, where ", reach,
             ": it seems to be in millimetres or centimetres; scale it to metres");
  } else if (extent < kTooSmall * scan_reach_m) {
    finding.sentence =
        text(spans, ", where ", reach,
             ": it seems to be in kilometres, or of another place; scale it to metres");
  } else {
    return {};
  }
  return {finding};
}

}  // namespace paloc
