#include "paloc/tools/svg_axes.h"

#include <algorithm>
#include <cmath>

#include "paloc/tools/html_text.h"

namespace paloc {
namespace {

double powerOfTenBelow(double value) {
  return std::pow(10.0, std::floor(std::log10(value) + 1e-9));
}

double roundStep(double least) {
  const double power = powerOfTenBelow(least);
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

}  // namespace

AxisTicks roundTicks(const PlotRange& range, int wanted) {
  AxisTicks ticks;
  if (!(range.length() > 0) || !std::isfinite(range.length())) return ticks;
  const double step = roundStep(range.length() / wanted);
  ticks.decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 9);
  const double first = std::ceil(range.min / step - 1e-9);
  const double last = std::floor(range.max / step + 1e-9);
  for (double i = first; i <= last; ++i) ticks.values.push_back(i * step);
  return ticks;
}

AxisTicks decadeTicks(const PlotRange& range) {
  AxisTicks ticks;
  const double first = std::ceil(std::log10(range.min) - 1e-9);
  const double last = std::floor(std::log10(range.max) + 1e-9);
  for (double i = first; i <= last; ++i) ticks.values.push_back(std::pow(10.0, i));
  ticks.decimals = std::clamp(static_cast<int>(-first), 0, 9);
  return ticks;
}

double roundDown(double value) {
  const double power = powerOfTenBelow(value);
  if (5 * power <= value) return 5 * power;
  return 2 * power <= value ? 2 * power : power;
}

std::string svgNumber(double value) { return fixedNumber(value, 2); }

std::string svgText(double x, double y, const std::string& anchor, const std::string& text,
                    const std::string& css) {
  return "<text class=\"" + css + "\" x=\"" + svgNumber(x) + "\" y=\"" + svgNumber(y) +
         "\" text-anchor=\"" + anchor + "\">" + escapeHtml(text) + "</text>";
}

std::string svgLine(double x1, double y1, double x2, double y2, const std::string& css) {
  return "<line class=\"" + css + "\" x1=\"" + svgNumber(x1) + "\" y1=\"" + svgNumber(y1) +
         "\" x2=\"" + svgNumber(x2) + "\" y2=\"" + svgNumber(y2) + "\"/>";
}

}  // namespace paloc
