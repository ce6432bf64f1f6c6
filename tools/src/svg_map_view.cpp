#include "paloc/tools/svg_map_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "paloc/tools/density_image.h"
#include "paloc/tools/html_text.h"
#include "paloc/tools/trajectory_stretches.h"

namespace paloc {
namespace {

constexpr double kWidth = 1000, kLeft = 66, kRight = 12, kTop = 12, kBottom = 58;
constexpr double kPlotWidth = kWidth - kLeft - kRight;
constexpr std::array<const char*, 3> kAxisNames = {"x (m)", "y (m)", "z (m)"};

struct Map {
  const std::vector<Point3f>& points;
  const Vec3& origin;
};

struct Window {
  PlotRange right, up;  ///< m, equal scale

  double scale() const { return kPlotWidth / right.length(); }
  double plotHeight() const { return up.length() * scale(); }
  double height() const { return kTop + plotHeight() + kBottom; }
  double x(double m) const { return kLeft + (m - right.min) * scale(); }
  double y(double m) const { return kTop + (up.max - m) * scale(); }
};

double positionAlong(const TrajectoryPoint& point, int axis) {
  return point.T_map_body.m_coords[axis];
}

double positionAlong(const Point3f& p, int axis) {
  return static_cast<double>(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
}

// All of the list but a share of stray ones at either end.
template <typename Points>
PlotRange rangeAlong(const Points& points, int axis, double stray_share) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const auto& point : points) values.push_back(positionAlong(point, axis));
  const auto skip = static_cast<std::ptrdiff_t>(stray_share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + skip, values.end());
  const double low = values[static_cast<std::size_t>(skip)];
  std::nth_element(values.begin(), values.end() - 1 - skip, values.end());
  return {low, *(values.end() - 1 - skip)};
}

PlotRange mapRangeAlong(const Map& map, int axis) {
  const PlotRange range = rangeAlong(map.points, axis, 0.002);
  return {range.min + map.origin[axis], range.max + map.origin[axis]};
}

// The trajectory with the map about it; the map where there is no trajectory.
PlotRange shownAlong(int axis, const std::vector<TrajectoryPoint>& trajectory, const Map& map) {
  if (trajectory.empty() && map.points.empty()) return {-1, 1};
  if (trajectory.empty()) return mapRangeAlong(map, axis);
  const PlotRange way = rangeAlong(trajectory, axis, 0);
  const double margin = std::max(0.2 * way.length(), 1.0);
  if (map.points.empty()) return {way.min - margin, way.max + margin};
  const PlotRange charted = mapRangeAlong(map, axis);
  const double context = std::max(0.5 * way.length(), 10.0);
  return {std::max(way.min - context, std::min(charted.min, way.min - 0.5)),
          std::min(way.max + context, std::max(charted.max, way.max + 0.5))};
}

void widen(PlotRange& range, double length) {
  const double more = std::max(0.0, length - range.length()) / 2;
  range.min -= more;
  range.max += more;
}

Window windowOf(const MapView& view, const std::vector<TrajectoryPoint>& trajectory,
                const Map& map) {
  Window w{shownAlong(view.right_axis, trajectory, map), shownAlong(view.up_axis, trajectory, map)};
  widen(w.right, 1.0);
  widen(w.up, view.min_aspect * w.right.length());
  widen(w.right, w.up.length() / view.max_aspect);
  return w;
}

std::string gridAndAxes(const MapView& view, const Window& w) {
  std::string grid, labels;
  const double floor_y = kTop + w.plotHeight();
  const AxisTicks right = roundTicks(w.right, 10);
  for (const double m : right.values) {
    grid += svgLine(w.x(m), kTop, w.x(m), floor_y, "grid");
    labels += svgText(w.x(m), floor_y + 22, "middle", fixedNumber(m, right.decimals));
  }
  const AxisTicks up = roundTicks(w.up, std::clamp(static_cast<int>(w.plotHeight() / 50), 3, 10));
  for (const double m : up.values) {
    grid += svgLine(kLeft, w.y(m), kWidth - kRight, w.y(m), "grid");
    labels += svgText(kLeft - 6, w.y(m) + 4, "end", fixedNumber(m, up.decimals));
  }
  labels += svgText(kLeft + kPlotWidth / 2, w.height() - 8, "middle",
                    kAxisNames[static_cast<std::size_t>(view.right_axis)], "unit");
  return grid + labels + "<text class=\"unit\" text-anchor=\"middle\" transform=\"translate(15 " +
         svgNumber(kTop + w.plotHeight() / 2) + ") rotate(-90)\">" +
         kAxisNames[static_cast<std::size_t>(view.up_axis)] + "</text>";
}

std::string mapPicture(const MapView& view, const Window& w, const Map& map) {
  if (map.points.empty()) return "";
  const double right_origin = map.origin[view.right_axis], up_origin = map.origin[view.up_axis];
  const PlotRange right{w.right.min - right_origin, w.right.max - right_origin};
  const PlotRange up{w.up.min - up_origin, w.up.max - up_origin};
  OpacityImage image = densityImage(map.points, view.right_axis, view.up_axis, right, up, 920);
  image.red = 71, image.green = 85, image.blue = 105;
  const double height =
      kPlotWidth * static_cast<double>(image.height) / static_cast<double>(image.width);
  return "<image class=\"map\" x=\"" + svgNumber(kLeft) + "\" y=\"" + svgNumber(kTop) +
         "\" width=\"" + svgNumber(kPlotWidth) + "\" height=\"" + svgNumber(height) +
         "\" href=\"data:image/png;base64," + base64(encodePng(image)) + "\"/>";
}

// Points that lie within half a unit of the one before are not drawn: no one could see them.
std::string pathOf(const MapView& view, const Window& w,
                   const std::vector<TrajectoryPoint>& trajectory, std::size_t first,
                   std::size_t last, const std::string& css) {
  std::string path;
  double last_x = INFINITY, last_y = INFINITY;
  for (std::size_t i = first; i <= last; ++i) {
    const double x = w.x(positionAlong(trajectory[i], view.right_axis));
    const double y = w.y(positionAlong(trajectory[i], view.up_axis));
    if (i != first && i != last && std::hypot(x - last_x, y - last_y) < 0.5) continue;
    path += (path.empty() ? 'M' : 'L') + svgNumber(x) + ' ' + svgNumber(y);
    last_x = x, last_y = y;
  }
  return "<path class=\"" + css + "\" d=\"" + path + "\"/>";
}

std::string trajectoryPaths(const MapView& view, const Window& w,
                            const std::vector<TrajectoryPoint>& trajectory) {
  if (trajectory.empty()) return "";
  std::string svg = pathOf(view, w, trajectory, 0, trajectory.size() - 1, "halo");
  const auto stretches = flagStretches(trajectory);
  // What is to be worried about lies on top.
  for (const PoseFlag flag :
       {PoseFlag::kGood, PoseFlag::kDegenerate, PoseFlag::kCoasting, PoseFlag::kLost}) {
    for (const FlagStretch& stretch : stretches) {
      if (stretch.flag != flag) continue;
      const std::size_t before = stretch.first > 0 ? stretch.first - 1 : 0;
      svg += pathOf(view, w, trajectory, before, stretch.last(), "way " + toString(flag));
    }
  }
  return svg;
}

std::string mark(const MapView& view, const Window& w, const TrajectoryPoint& point,
                 const std::string& name, double label_dy) {
  const double x = w.x(positionAlong(point, view.right_axis));
  const double y = w.y(positionAlong(point, view.up_axis));
  const bool near_edge = x > kWidth - 90;
  const std::string shape = name == "start"
                                ? "<circle class=\"mark\" cx=\"" + svgNumber(x) + "\" cy=\"" +
                                      svgNumber(y) + "\" r=\"6\"/>"
                                : "<rect class=\"mark\" x=\"" + svgNumber(x - 5.5) + "\" y=\"" +
                                      svgNumber(y - 5.5) + "\" width=\"11\" height=\"11\"/>";
  return shape + svgText(x + (near_edge ? -11 : 11), y + label_dy, near_edge ? "end" : "start",
                         name, "marktext");
}

std::string scaleBar(const Window& w) {
  const double length_m = roundDown(w.right.length() / 5);
  const double end = kWidth - kRight - 16, begin = end - length_m * w.scale();
  const double y = kTop + w.plotHeight() - 14;
  const std::string path = " d=\"M" + svgNumber(begin) + ' ' + svgNumber(y - 5) + "v10m0-5H" +
                           svgNumber(end) + "m0-5v10\"/>";
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(length_m) + 1e-9)));
  return "<path class=\"scalehalo\"" + path + "<path class=\"scalebar\"" + path +
         svgText((begin + end) / 2, y - 9, "middle", fixedNumber(length_m, decimals) + " m",
                 "marktext");
}

}  // namespace

std::string mapViewFigure(const MapView& view, const std::vector<TrajectoryPoint>& trajectory,
                          const std::vector<Point3f>& map_points, const Vec3& map_origin) {
  const Map map{map_points, map_origin};
  const Window w = windowOf(view, trajectory, map);
  const std::string label = view.title + ": the trajectory, coloured by flag, over the map";
  std::string svg = "<svg class=\"mapview\" viewBox=\"0 0 " + svgNumber(kWidth) + ' ' +
                    svgNumber(w.height()) + "\" role=\"img\" aria-label=\"" + escapeHtml(label) +
                    "\">";
  svg += "<rect class=\"paper\" x=\"" + svgNumber(kLeft) + "\" y=\"" + svgNumber(kTop) +
         "\" width=\"" + svgNumber(kPlotWidth) + "\" height=\"" + svgNumber(w.plotHeight()) +
         "\"/>";
  svg += mapPicture(view, w, map) + gridAndAxes(view, w) + trajectoryPaths(view, w, trajectory);
  if (!trajectory.empty()) {
    svg += mark(view, w, trajectory.back(), "end", 17) +
           mark(view, w, trajectory.front(), "start", -7);
  }
  return "<figure class=\"plot\"><figcaption><h3>" + escapeHtml(view.title) +
         "</h3></figcaption>\n" + svg + scaleBar(w) + "</svg>\n</figure>\n";
}

}  // namespace paloc
