#include "paloc/tools/density_image.h"

#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

double coordinate(const Point3f& p, int axis) {
  return static_cast<double>(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
}

// The count that is drawn fully opaque: all but the densest hundredth of the pixels lie below.
double opaqueCount(const std::vector<std::uint32_t>& counts) {
  std::vector<std::uint32_t> seen;
  std::copy_if(counts.begin(), counts.end(), std::back_inserter(seen),
               [](std::uint32_t n) { return n > 0; });
  if (seen.empty()) return 1;
  const auto place =
      seen.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(seen.size() - 1));
  std::nth_element(seen.begin(), place, seen.end());
  return std::max(2.0, static_cast<double>(*place));
}

}  // namespace

OpacityImage densityImage(const std::vector<Point3f>& points, int right_axis, int up_axis,
                          const PlotRange& right, const PlotRange& up, std::size_t width) {
  OpacityImage image;
  const double pixel_m = right.length() / static_cast<double>(width);
  image.width = width;
  image.height =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(up.length() / pixel_m)));
  std::vector<std::uint32_t> counts(image.width * image.height, 0);
  for (const Point3f& p : points) {
    const double column = std::floor((coordinate(p, right_axis) - right.min) / pixel_m);
    const double row = std::floor((up.max - coordinate(p, up_axis)) / pixel_m);
    const bool inside = column >= 0 && row >= 0 && column < static_cast<double>(image.width) &&
                        row < static_cast<double>(image.height);
    if (!inside) continue;
    ++counts[static_cast<std::size_t>(row) * image.width + static_cast<std::size_t>(column)];
  }
  // The logarithm keeps single points to be seen beside walls that are hit a hundred times.
  const double opaque = std::log1p(opaqueCount(counts));
  image.opacity.reserve(counts.size());
  for (const std::uint32_t n : counts) {
    const double share = std::min(1.0, std::log1p(static_cast<double>(n)) / opaque);
    image.opacity.push_back(static_cast<std::uint8_t>(std::lround(255 * std::pow(share, 1.5))));
  }
  return image;
}

}  // namespace paloc
