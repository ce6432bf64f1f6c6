#pragma once

#include <string>
#include <vector>

namespace paloc {

/// An interval of what is shown along one axis.
struct PlotRange {
  double min = 0;
  double max = 1;

  double length() const { return max - min; }
};

/// Marks of an axis at round values (1, 2 or 5 times a power of ten), and the decimals they need.
struct AxisTicks {
  std::vector<double> values;
  int decimals = 0;
};

/// About `wanted` ticks within the range.
AxisTicks roundTicks(const PlotRange& range, int wanted);

/// Powers of ten within the range of a logarithmic axis (values, not logarithms).
AxisTicks decadeTicks(const PlotRange& range);

/// The largest round value that is at most `value` (> 0).
double roundDown(double value);

/// A coordinate of an SVG, in its user units: two decimals.
std::string svgNumber(double value);

/// `<text class="CSS" x= y= text-anchor=ANCHOR>TEXT</text>`, the text escaped.
std::string svgText(double x, double y, const std::string& anchor, const std::string& text,
                    const std::string& css = "tick");

/// `<line class="CSS" .../>`
std::string svgLine(double x1, double y1, double x2, double y2, const std::string& css);

}  // namespace paloc
