#include "paloc/tools/svg_time_plot.h"

#include <algorithm>
#include <cmath>

#include "paloc/tools/html_text.h"
#include "paloc/tools/quantile.h"

namespace paloc {
namespace {

// Sizes in the SVG's own units, which are about pixels.
struct Layout {
  std::string css;
  double width = 0, height = 0;
  double left = 0, right = 0, top = 8, bottom = 38;
  int time_ticks = 0, value_ticks = 0;

  double plotWidth() const { return width - left - right; }
  double plotHeight() const { return height - top - bottom; }
};

const Layout kWide{"wide", 1000, 220, 62, 12, 8, 40, 10, 4};
const Layout kNarrow{"narrow", 380, 210, 48, 8, 8, 40, 5, 4};

struct Scales {
  const Layout& layout;
  PlotRange time_s, value;
  bool logarithmic = false;

  double x(double t_s) const {
    return layout.left + (t_s - time_s.min) / time_s.length() * layout.plotWidth();
  }
  double y(double v) const {
    const double share = logarithmic ? std::log(v / value.min) / std::log(value.max / value.min)
                                     : (v - value.min) / value.length();
    return layout.top + (1 - std::clamp(share, -0.05, 1.05)) * layout.plotHeight();
  }
  bool shows(double v) const { return std::isfinite(v) && (!logarithmic || v > 0); }
};

PlotRange dataRange(const TimePlot& plot) {
  PlotRange range{INFINITY, -INFINITY};
  for (const PlotLine& line : plot.lines) {
    for (const double v : line.values) {
      if (!std::isfinite(v) || (plot.logarithmic && v <= 0)) continue;
      range.min = std::min(range.min, v);
      range.max = std::max(range.max, v);
    }
  }
  return range.min <= range.max ? range : PlotRange{plot.logarithmic ? 0.1 : 0, 1};
}

PlotRange valueRange(const TimePlot& plot) {
  PlotRange range = dataRange(plot);
  if (plot.logarithmic) {
    range.min = std::pow(10, std::floor(std::log10(range.min) + 1e-9));
    range.max = std::pow(10, std::ceil(std::log10(range.max) - 1e-9));
    return range.max > range.min ? range : PlotRange{range.min, 10 * range.min};
  }
  if (plot.from_zero) range.min = std::min(0.0, range.min);
  if (plot.reaches > 0) range.max = std::max(range.max, plot.reaches / 1.06);
  if (!(range.length() > 0)) return {range.min - 0.5, range.min + 0.5};
  if (!plot.from_zero) range.min -= 0.06 * range.length();
  range.max += 0.06 * range.length();
  return range;
}

PlotRange timeRange(const TimePlot& plot) {
  return plot.time_s.length() > 0 ? plot.time_s : PlotRange{plot.time_s.min, plot.time_s.min + 1};
}

std::string timeAxis(const Scales& s) {
  const Layout& l = s.layout;
  const double floor_y = l.height - l.bottom;
  std::string svg;
  const AxisTicks ticks = roundTicks(s.time_s, l.time_ticks);
  for (const double t : ticks.values) {
    svg += svgLine(s.x(t), floor_y, s.x(t), floor_y + 4, "axis");
    svg += svgText(s.x(t), floor_y + 17, "middle", fixedNumber(t, ticks.decimals));
  }
  svg += svgLine(l.left, floor_y, l.width - l.right, floor_y, "axis");
  return svg + svgText(l.left + l.plotWidth() / 2, l.height - 5, "middle", "time (s)", "unit");
}

int decimalsOf(double power_of_ten) {
  return std::max(0, static_cast<int>(-std::floor(std::log10(power_of_ten) + 1e-9)));
}

std::string valueAxis(const Scales& s, const std::string& unit) {
  const Layout& l = s.layout;
  const AxisTicks ticks = s.logarithmic ? decadeTicks(s.value) : roundTicks(s.value, l.value_ticks);
  std::string svg;
  for (const double v : ticks.values) {
    svg += svgLine(l.left, s.y(v), l.width - l.right, s.y(v), "grid");
    const std::string text = fixedNumber(v, s.logarithmic ? decimalsOf(v) : ticks.decimals);
    svg += svgText(l.left - 6, s.y(v) + 4, "end", text);
  }
  const std::string middle = svgNumber(l.top + l.plotHeight() / 2);
  return svg + R"(<text class="unit" text-anchor="middle" transform="translate(13 )" + middle +
         ") rotate(-90)\">" + escapeHtml(unit) + "</text>";
}

std::string bandsOf(const TimePlot& plot, const Scales& s) {
  std::string svg;
  for (const PlotBand& band : plot.bands) {
    // A stretch of a single pose is still to be seen.
    const double begin = s.x(band.begin_s);
    const double width = std::max(1.5, s.x(band.end_s) - begin);
    svg += "<rect class=\"" + band.css + "\" x=\"" + svgNumber(begin) + "\" y=\"" +
           svgNumber(s.layout.top) + "\" width=\"" + svgNumber(width) + "\" height=\"" +
           svgNumber(s.layout.plotHeight()) + "\">" +
           (band.label.empty() ? "" : "<title>" + escapeHtml(band.label) + "</title>") + "</rect>";
  }
  return svg;
}

// Points of one column of pixels: the first, the extremes and the last are all that can be seen.
struct Column {
  long pixel = 0;
  double x = 0, first = 0, low = 0, high = 0, last = 0;
};

void flush(std::string& path, const Column& column, bool& pen_down) {
  const auto to = [&](double y) {
    path += (pen_down ? 'L' : 'M') + svgNumber(column.x) + ' ' + svgNumber(y);
    pen_down = true;
  };
  to(column.first);
  if (column.low != column.first && column.low != column.last) to(column.low);
  if (column.high != column.first && column.high != column.last) to(column.high);
  if (column.last != column.first) to(column.last);
}

double longestStep(const PlotLine& line) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < line.t_s.size(); ++i) steps.push_back(line.t_s[i] - line.t_s[i - 1]);
  if (steps.empty()) return INFINITY;
  return std::max(1.0, 5 * quantile(std::move(steps), 0.5));
}

std::string curve(const PlotLine& line, const Scales& s) {
  const double max_step_s = longestStep(line);
  std::string path;
  bool pen_down = false, open = false;
  Column column;
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    const bool hole = i > 0 && line.t_s[i] - line.t_s[i - 1] > max_step_s;
    if (hole || !s.shows(line.values[i])) {
      if (open) flush(path, column, pen_down);
      open = pen_down = false;
      if (!s.shows(line.values[i])) continue;
    }
    const double x = s.x(line.t_s[i]), y = s.y(line.values[i]);
    const long pixel = std::lround(2 * x);
    if (open && pixel == column.pixel) {
      column.low = std::min(column.low, y);
      column.high = std::max(column.high, y);
      column.last = y;
      continue;
    }
    if (open) flush(path, column, pen_down);
    column = {pixel, x, y, y, y, y};
    open = true;
  }
  if (open) flush(path, column, pen_down);
  return path.empty() ? "" : "<path class=\"line " + line.css + "\" d=\"" + path + "\"/>";
}

std::string dotsOf(const PlotLine& line, const Scales& s) {
  std::string path;
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    if (!s.shows(line.values[i])) continue;
    path += 'M' + svgNumber(s.x(line.t_s[i])) + ' ' + svgNumber(s.y(line.values[i])) + "h0";
  }
  return path.empty() ? "" : "<path class=\"dots " + line.css + "\" d=\"" + path + "\"/>";
}

std::string openSvg(const Layout& l, const TimePlot& plot) {
  const std::string label = plot.title + (plot.unit.empty() ? "" : " (" + plot.unit + ")") +
                            " over time. " + plot.summary;
  return "<svg class=\"" + l.css + "\" viewBox=\"0 0 " + svgNumber(l.width) + ' ' +
         svgNumber(l.height) + R"(" role="img" aria-label=")" + escapeHtml(label) + "\">";
}

std::string plotSvg(const TimePlot& plot, const Layout& layout) {
  const Scales s{layout, timeRange(plot), valueRange(plot), plot.logarithmic};
  std::string svg = openSvg(layout, plot) + bandsOf(plot, s) + valueAxis(s, plot.unit);
  for (const PlotLine& line : plot.lines) svg += line.dots ? dotsOf(line, s) : curve(line, s);
  return svg + timeAxis(s) + "</svg>\n";
}

std::string legend(const TimePlot& plot) {
  std::string items;
  for (const PlotLine& line : plot.lines) {
    if (line.label.empty()) continue;
    items += "<li><span class=\"swatch " + std::string(line.dots ? "dot " : "") + line.css +
             "\"></span>" + escapeHtml(line.label) + "</li>";
  }
  return items.empty() ? "" : "<ul class=\"legend\">" + items + "</ul>";
}

std::string caption(const TimePlot& plot) {
  const std::string unit = plot.unit.empty() ? "" : " <small>" + escapeHtml(plot.unit) + "</small>";
  return "<figcaption><h3>" + escapeHtml(plot.title) + unit + "</h3>" + legend(plot) +
         (plot.summary.empty() ? "" : "<p>" + escapeHtml(plot.summary) + "</p>") + "</figcaption>";
}

}  // namespace

std::string timePlotFigure(const TimePlot& plot) {
  return "<figure class=\"plot\">" + caption(plot) + '\n' + plotSvg(plot, kWide) +
         plotSvg(plot, kNarrow) + "</figure>\n";
}

std::string timeBandFigure(const TimePlot& plot) {
  std::string figure = "<figure class=\"plot\">" + caption(plot) + '\n';
  for (Layout layout : {kWide, kNarrow}) {
    layout.height = 72;
    const Scales s{layout, timeRange(plot), {0, 1}, false};
    figure += openSvg(layout, plot) + bandsOf(plot, s) + timeAxis(s) + "</svg>\n";
  }
  return figure + "</figure>\n";
}

}  // namespace paloc
