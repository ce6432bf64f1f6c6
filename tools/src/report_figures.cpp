#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "paloc/core/seconds_text.h"
#include "paloc/tools/html_text.h"
#include "paloc/tools/quantile.h"
#include "paloc/tools/report_sections.h"
#include "paloc/tools/svg_map_view.h"
#include "paloc/tools/svg_time_plot.h"

namespace paloc::report {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Seconds after the first frame, whether it has a pose or not.
TimeNs timeZero(const Result& result) {
  if (result.diagnostics.empty()) return result.trajectory.front().t_ns;
  if (result.trajectory.empty()) return result.diagnostics.front().t_ns;
  return std::min(result.diagnostics.front().t_ns, result.trajectory.front().t_ns);
}

PlotRange timeSpan(const Result& result) {
  const TimeNs zero_ns = timeZero(result);
  PlotRange span{0, 0};
  if (!result.diagnostics.empty())
    span.max = secondsBetween(zero_ns, result.diagnostics.back().t_ns);
  if (!result.trajectory.empty()) {
    span.max = std::max(span.max, secondsBetween(zero_ns, result.trajectory.back().t_ns));
  }
  return span;
}

template <typename Rows, typename Value>
PlotLine lineOf(const std::string& css, const std::string& label, TimeNs zero_ns, const Rows& rows,
                Value value) {
  PlotLine line;
  line.css = css;
  line.label = label;
  for (const auto& row : rows) {
    line.t_s.push_back(secondsBetween(zero_ns, row.t_ns));
    line.values.push_back(value(row));
  }
  return line;
}

struct Highest {
  double value = kNone;
  double t_s = 0;
};

Highest highestOf(const PlotLine& line) {
  Highest highest;
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    if (!std::isfinite(line.values[i]) || line.values[i] <= highest.value) continue;
    highest = {line.values[i], line.t_s[i]};
  }
  return highest;
}

double medianOf(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  return values.empty() ? kNone : quantile(std::move(values), 0.5);
}

std::string summaryOfLine(const PlotLine& line, const std::string& unit) {
  const Highest highest = highestOf(line);
  if (!std::isfinite(highest.value)) return "No map factor was used.";
  return "Median " + shortNumber(medianOf(line.values)) + ' ' + unit + ", highest " +
         shortNumber(highest.value) + ' ' + unit + " at " + fixedNumber(highest.t_s, 1) + " s.";
}

// Lengths in the unit that makes the numbers easy to read.
void scaleLengths(TimePlot& plot) {
  double highest = 0;
  for (const PlotLine& line : plot.lines) {
    const double v = highestOf(line).value;
    if (std::isfinite(v)) highest = std::max(highest, v);
  }
  const double factor = highest < 0.02 ? 1000 : highest < 2 ? 100 : 1;
  plot.unit = highest < 0.02 ? "mm" : highest < 2 ? "cm" : "m";
  for (PlotLine& line : plot.lines) {
    for (double& v : line.values) v *= factor;
  }
}

// Far apart, small values are only to be seen on a logarithmic axis.
void chooseScale(TimePlot& plot) {
  const PlotLine& first = plot.lines.front();
  plot.logarithmic = highestOf(first).value > 30 * medianOf(first.values);
}

// Time between two poses belongs to the later one's stretch, so that neighbours meet.
std::vector<PlotBand> bandsOf(const ReportSummary& summary, TimeNs zero_ns,
                              const std::string& prefix, bool with_good) {
  std::vector<PlotBand> bands;
  double begin_s = 0;
  for (const FlagStretch& stretch : summary.stretches) {
    if (stretch.first == 0) begin_s = secondsBetween(zero_ns, stretch.begin_ns);
    const double end_s = secondsBetween(zero_ns, stretch.end_ns);
    const std::string flag = toString(stretch.flag);
    if (stretch.flag != PoseFlag::kGood || with_good) {
      bands.push_back({prefix + flag, begin_s, end_s,
                       flag + ", " + fixedNumber(secondsBetween(zero_ns, stretch.begin_ns), 1) +
                           " s to " + fixedNumber(end_s, 1) + " s, " +
                           counted(stretch.count, "pose", "poses")});
    }
    begin_s = end_s;
  }
  return bands;
}

std::string flagLegend(const ReportSummary& s) {
  struct Entry {
    PoseFlag flag;
    const char* meaning;
  };
  std::string html = "<ul class=\"legend flags\">";
  for (const Entry& e :
       {Entry{PoseFlag::kGood, "fixed by the map in all six directions"},
        Entry{PoseFlag::kDegenerate, "a direction is weak or open"},
        Entry{PoseFlag::kCoasting, "no map factor near"}, Entry{PoseFlag::kLost, "do not use"}}) {
    if (s.count(e.flag) == 0) continue;
    const std::string name = toString(e.flag);
    html += "<li><span class=\"swatch " + name + "\"></span><b>" + name + "</b> \xE2\x80\x93 " +
            e.meaning + " (" + counted(s.count(e.flag), "pose", "poses") + ")</li>";
  }
  return html + "</ul>\n";
}

/// Collects what all plots of a report share.
class TimePlots {
 public:
  TimePlots(const Result& result, const ReportSummary& summary)
      : result_(result), summary_(summary), zero_ns_(timeZero(result)) {}

  std::string flags() const {
    TimePlot plot = blank("Flag");
    plot.bands = bandsOf(summary_, zero_ns_, "band-", true);
    return timeBandFigure(plot);
  }

  std::string residual() const {
    TimePlot plot = blank("Residual of the inliers to the map, rms");
    const auto value = [](const FrameDiagnostics& d) { return d.match.residual_rms_m; };
    plot.lines = frameLines("residual", value);
    scaleLengths(plot);
    plot.summary = summaryOfLine(plot.lines.front(), plot.unit);
    return timePlotFigure(plot);
  }

  std::string inliers() const {
    TimePlot plot = blank("Overlap and inliers");
    plot.unit = "% of the points";
    plot.reaches = 100;
    plot.lines.push_back(
        line("s1", "overlap: found a plane of the map", [](const FrameDiagnostics& d) {
          return d.match.points > 0 ? 100 * d.match.overlap : kNone;
        }));
    plot.lines.push_back(line("s2", "inliers: within the gate", [](const FrameDiagnostics& d) {
      return d.match.points > 0 ? 100.0 * d.match.inliers / d.match.points : kNone;
    }));
    const PlotLine counts = line("", "", [](const FrameDiagnostics& d) {
      return d.match.points > 0 ? static_cast<double>(d.match.points) : kNone;
    });
    const double points = medianOf(counts.values);
    if (std::isfinite(points)) {
      plot.summary = "Of " + fixedNumber(points, 0) + " points of the filtered scan at the median.";
    }
    return timePlotFigure(plot);
  }

  std::string positionSigmas() const {
    TimePlot plot = blank("Position, one standard deviation");
    plot.lines.push_back(poseLine("total", "worst direction", positionSigma));
    addAxes(plot, "along map ", 0, 1);
    scaleLengths(plot);
    chooseScale(plot);
    plot.summary = "Worst direction: " + summaryOfLine(plot.lines.front(), plot.unit);
    return timePlotFigure(plot);
  }

  std::string rotationSigmas() const {
    TimePlot plot = blank("Rotation, one standard deviation");
    plot.unit = "deg";
    plot.lines.push_back(poseLine("total", "worst axis", [](const TrajectoryPoint& p) {
      return kDegrees * rotationSigma(p);
    }));
    addAxes(plot, "about body ", 3, kDegrees);
    chooseScale(plot);
    plot.summary = "Worst axis: " + summaryOfLine(plot.lines.front(), plot.unit);
    return timePlotFigure(plot);
  }

  std::string positionStep() const {
    TimePlot plot = blank("Step from prediction to match, position");
    plot.lines =
        frameLines("step", [](const FrameDiagnostics& d) { return d.guess_step_position.norm(); });
    scaleLengths(plot);
    plot.summary = summaryOfLine(plot.lines.front(), plot.unit);
    return timePlotFigure(plot);
  }

  std::string rotationStep() const {
    TimePlot plot = blank("Step from prediction to match, rotation");
    plot.unit = "deg";
    plot.lines = frameLines("step", [](const FrameDiagnostics& d) {
      return kDegrees * std::abs(d.guess_step_rotation);
    });
    plot.summary = summaryOfLine(plot.lines.front(), plot.unit);
    return timePlotFigure(plot);
  }

  std::string height() const {
    TimePlot plot = blank("Height");
    plot.unit = "z (m)";
    plot.from_zero = false;
    plot.lines.push_back(
        poseLine("s1", "", [](const TrajectoryPoint& p) { return p.T_map_body.z(); }));
    return timePlotFigure(plot);
  }

 private:
  TimePlot blank(const std::string& title) const {
    TimePlot plot;
    plot.title = title;
    plot.time_s = timeSpan(result_);
    plot.bands = bandsOf(summary_, zero_ns_, "shade-", false);
    return plot;
  }

  template <typename Value>
  PlotLine line(const std::string& css, const std::string& label, Value value) const {
    return lineOf(css, label, zero_ns_, result_.diagnostics, value);
  }
  template <typename Value>
  PlotLine poseLine(const std::string& css, const std::string& label, Value value) const {
    return lineOf(css, label, zero_ns_, result_.trajectory, value);
  }

  // Frames whose match was used as a line, those refused that had one as marks.
  template <typename Value>
  std::vector<PlotLine> frameLines(const std::string& what, Value value) const {
    PlotLine used = line("s1", "map factor used", [&](const FrameDiagnostics& d) {
      return d.match.accepted() ? value(d) : kNone;
    });
    PlotLine refused =
        line("refused", what + " of refused matches", [&](const FrameDiagnostics& d) {
          return !d.match.accepted() && d.match.inliers > 0 ? value(d) : kNone;
        });
    refused.dots = true;
    if (!std::isfinite(highestOf(refused).value)) return {used};
    return {used, refused};
  }

  void addAxes(TimePlot& plot, const std::string& label, Eigen::Index first, double factor) const {
    const char* const css[] = {"s1", "s2", "s3"};
    const char* const names[] = {"x", "y", "z"};
    for (Eigen::Index i = 0; i < 3; ++i) {
      plot.lines.push_back(poseLine(css[i], label + names[i], [&](const TrajectoryPoint& p) {
        return factor * std::sqrt(p.covariance(first + i, first + i));
      }));
    }
  }

  const Result& result_;
  const ReportSummary& summary_;
  TimeNs zero_ns_;
};

}  // namespace

std::string mapSection(const ReportData& data, const ReportSummary& summary) {
  const auto& trajectory = data.result.trajectory;
  if (trajectory.empty() && data.map_points.empty()) return "";
  std::string html = "<section aria-labelledby=\"map\">\n<h2 id=\"map\">" +
                     std::string(trajectory.empty() ? "The map" : "Trajectory over the map") +
                     "</h2>\n<p class=\"lead\">Positions of the body in the map frame" +
                     (data.map_points.empty() ? "." : "; the prior map in grey.") + "</p>\n";
  if (!trajectory.empty()) html += flagLegend(summary);
  const auto view = [&](const MapView& v) {
    return mapViewFigure(v, trajectory, data.map_points, data.map_origin);
  };
  html += view({"From above", 0, 1, 0.3, 0.8});
  if (!trajectory.empty()) {
    // From the side along which the way is longer.
    PlotRange x{INFINITY, -INFINITY}, y{INFINITY, -INFINITY};
    for (const TrajectoryPoint& p : trajectory) {
      x = {std::min(x.min, p.T_map_body.x()), std::max(x.max, p.T_map_body.x())};
      y = {std::min(y.min, p.T_map_body.y()), std::max(y.max, p.T_map_body.y())};
    }
    const int axis = y.length() > x.length() ? 1 : 0;
    html += view({"From the side", axis, 2, 0.12, 0.5});
    html += TimePlots(data.result, summary).height();
  }
  return html + "</section>\n";
}

std::string timeSection(const ReportData& data, const ReportSummary& summary) {
  if (data.result.trajectory.empty() && data.result.diagnostics.empty()) return "";
  const TimePlots plots(data.result, summary);
  const TimeNs zero_ns = timeZero(data.result);
  std::string html =
      "<section aria-labelledby=\"time\">\n<h2 id=\"time\">Over time</h2>\n<p class=\"lead\">"
      "Time is counted from the first frame, " +
      secondsText(zero_ns) + " s.";
  if (!summary.stretches.empty()) html += " Stretches that are not good are shaded.";
  html += "</p>\n";
  if (summary.poses > 0) html += plots.flags();
  html += plots.residual() + plots.inliers();
  if (summary.poses > 0) html += plots.positionSigmas() + plots.rotationSigmas();
  return html + plots.positionStep() + plots.rotationStep() + "</section>\n";
}

}  // namespace paloc::report
