#include "paloc/tools/point_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/tools/quantile.h"

namespace paloc {
namespace {

struct UnitFacts {
  TimeUnit unit;
  const char* name;
  double ns;
};
constexpr std::array<UnitFacts, 4> kUnits{{{TimeUnit::kSeconds, "seconds", 1e9},
                                           {TimeUnit::kMilliseconds, "milliseconds", 1e6},
                                           {TimeUnit::kMicroseconds, "microseconds", 1e3},
                                           {TimeUnit::kNanoseconds, "nanoseconds", 1}}};

const UnitFacts& factsOf(TimeUnit unit) { return kUnits[static_cast<std::size_t>(unit)]; }

const char* nameOf(TimeReference reference) {
  switch (reference) {
    case TimeReference::kStamp:
      return "after the scan's stamp";
    case TimeReference::kAbsolute:
      return "on the clock of the stamps";
    case TimeReference::kEnd:
      return "before the scan's last point";
  }
  return "";
}

std::string number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof(buffer), "%.10g", value);
  return buffer;
}

template <typename F>
double medianOf(const std::vector<PointTimeSample>& samples, F&& value) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const auto& s : samples) values.push_back(static_cast<double>(value(s)));
  return quantile(std::move(values), 0.5);
}

[[noreturn]] void failUnclear(const PointTimeSample& s, const std::string& why) {
  throw IoError(text("the times in field '", s.field, "' cannot be told: ", why,
                     " (in the first scan ", number(s.min), " to ", number(s.max),
                     ", its stamp is ", number(static_cast<double>(s.stamp_ns) * 1e-9),
                     " s); state them with --time-unit and --time-reference"));
}

TimeUnit decideUnit(const std::vector<PointTimeSample>& samples, double spread, double period_s) {
  constexpr double kWorstFactor = 31;  // units are a factor of 1000 apart
  for (const auto& facts : kUnits) {
    const double ratio = spread * facts.ns * 1e-9 / period_s;
    if (ratio < 1 / kWorstFactor || ratio > kWorstFactor) continue;
    if (facts.unit == TimeUnit::kSeconds && samples.front().integer) continue;  // too coarse
    return facts.unit;
  }
  failUnclear(samples.front(), text("a scan's values span ", number(spread), ", and scans are ",
                                    number(period_s), " s apart: no unit fits"));
}

TimeReference decideReference(const std::vector<PointTimeSample>& samples, double unit_ns,
                              double period_s) {
  const auto seconds = [unit_ns](double value) { return value * unit_ns * 1e-9; };
  const auto stamp = [](const PointTimeSample& s) {
    return static_cast<double>(s.stamp_ns) * 1e-9;
  };
  const double from_stamp =
      medianOf(samples, [&](const auto& s) { return std::abs(seconds(s.min) - stamp(s)); });
  const double from_zero =
      medianOf(samples, [&](const auto& s) { return std::abs(seconds(s.min)); });
  const double end_from_zero =
      medianOf(samples, [&](const auto& s) { return std::abs(seconds(s.max)); });
  const double near = 2 * period_s;
  if (from_stamp < from_zero && from_stamp < std::max(near, 1.0)) return TimeReference::kAbsolute;
  const bool negative =
      medianOf(samples, [&](const auto& s) { return seconds(s.min + s.max); }) < 0;
  if (negative && end_from_zero < near) return TimeReference::kEnd;
  if (!negative && from_zero < near) return TimeReference::kStamp;
  failUnclear(samples.front(), "they lie neither near zero nor near the scans' stamps");
}

}  // namespace

double scanPeriod(const std::vector<TimeNs>& stamps) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const double step_s = secondsBetween(stamps[i - 1], stamps[i]);
    if (step_s > 0) steps_s.push_back(step_s);
  }
  constexpr double kUsual_s = 0.1;
  return steps_s.empty() ? kUsual_s : quantile(std::move(steps_s), 0.5);
}

PointTimeRule decidePointTimes(const std::vector<PointTimeSample>& samples, double period_s,
                               std::optional<TimeUnit> unit,
                               std::optional<TimeReference> reference) {
  const double spread = medianOf(samples, [](const auto& s) { return s.max - s.min; });
  PointTimeRule rule;
  rule.unit = unit ? *unit : decideUnit(samples, spread, period_s);
  const double unit_ns = factsOf(rule.unit).ns;
  rule.reference = reference ? *reference : decideReference(samples, unit_ns, period_s);
  const PointTimeSample& first = samples.front();
  rule.sentence = text("times of points: field '", first.field, "' (",
                       first.integer ? "integer" : "floating point", "), read as ",
                       factsOf(rule.unit).name, " ", nameOf(rule.reference), ": ");
  if (unit && reference) {
    rule.sentence += "as stated";
  } else {
    rule.sentence +=
        text("a scan's values span ", number(spread), ", that is ", number(spread * unit_ns * 1e-9),
             " s where scans are ", number(period_s), " s apart, and start at ", number(first.min),
             " in the first scan, whose stamp is ",
             number(static_cast<double>(first.stamp_ns) * 1e-9), " s");
    if (unit) rule.sentence += " (unit as stated)";
    if (reference) rule.sentence += " (reference as stated)";
  }
  return rule;
}

std::vector<TimeNs> readPointTimes(const PointTimeRule& rule, const std::vector<double>& values,
                                   TimeNs stamp_ns, std::optional<TimeNs> last_ns) {
  const double unit_ns = factsOf(rule.unit).ns;
  TimeNs base = rule.reference == TimeReference::kAbsolute ? 0 : stamp_ns;
  if (rule.reference == TimeReference::kEnd) {
    double min = 0;
    for (const double v : values) min = std::isfinite(v) ? std::min(min, v) : min;
    base = last_ns ? *last_ns : stamp_ns - std::llround(min * unit_ns);
  }
  constexpr double kBeyond = 9e18;  // further than 64 bits of nanoseconds reach
  std::vector<TimeNs> times(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    // long double: seconds since 1970 in nanoseconds do not fit the 53 bits of a double.
    const long double t_ns = static_cast<long double>(values[i]) * unit_ns;
    const bool fits = std::isfinite(values[i]) && std::abs(t_ns) < kBeyond / 2;
    times[i] = fits ? base + std::llround(t_ns) : kNoTime;
  }
  return times;
}

}  // namespace paloc
