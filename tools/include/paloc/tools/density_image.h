#pragma once

#include <vector>

#include "paloc/core/types.h"
#include "paloc/tools/png_image.h"
#include "paloc/tools/svg_axes.h"

namespace paloc {

/// Points seen along an axis, as a picture: the more of them in a pixel, the more opaque. `right`
/// and `up` (m) are what the picture shows of the axes `right_axis` and `up_axis` (0 x, 1 y, 2 z).
OpacityImage densityImage(const std::vector<Point3f>& points, int right_axis, int up_axis,
                          const PlotRange& right, const PlotRange& up, std::size_t width);

}  // namespace paloc
