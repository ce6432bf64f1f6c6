#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>

#include "paloc/core/seconds_text.h"
#include "paloc/core/text.h"
#include "paloc/tools/recording_info.h"

namespace paloc {
namespace {

std::string fixed(double value, int decimals) {
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), "%.*f", decimals, value);
  return buffer;
}

// "2026-11-22 19:00:00 UTC": empty for stamps that do not count from 1970.
std::string date(TimeNs t_ns) {
  constexpr TimeNs kYear1990 = 631'152'000LL * kNsPerSecond;
  if (t_ns < kYear1990) return {};
  const std::time_t seconds = t_ns / kNsPerSecond;
  std::tm utc{};
  char buffer[48];
  if (::gmtime_r(&seconds, &utc) == nullptr) return {};
  std::strftime(buffer, sizeof(buffer), " (%Y-%m-%d %H:%M:%S UTC)", &utc);
  return buffer;
}

struct Spread {
  std::uint64_t min = 0, median = 0, max = 0;
};

Spread spreadOf(std::vector<std::uint64_t> values) {
  std::sort(values.begin(), values.end());
  return {values.front(), values[values.size() / 2], values.back()};
}

std::optional<TimeNs> firstStamp(const SensorInfo& s) {
  if (s.stamps.empty()) return std::nullopt;
  return *std::min_element(s.stamps.begin(), s.stamps.end());
}

double meanRate(const SensorInfo& s, const StampSteps& steps) {
  return steps.span_s > 0 ? static_cast<double>(s.stamps.size() - 1) / steps.span_s : 0;
}

std::string timesLine(const SensorInfo& s) {
  const StampSteps steps = stepsOf(s);
  std::string line = text("  ", s.count, " observations");
  if (steps.period_s > 0) line += text(" at ", fixed(1 / steps.period_s, 2), " Hz");
  line += text(" over ", fixed(steps.span_s, 3), " s");
  if (steps.gaps > 0) line += text(" (", fixed(meanRate(s, steps), 2), " Hz on average)");
  if (const auto first = firstStamp(s))
    line += text(", from ", secondsText(*first), " s", date(*first));
  line += '\n';
  if (steps.gaps > 0) {
    line += text("  gaps: ", steps.gaps, " above 1.5 periods, the largest ",
                 fixed(steps.largest_gap_s, 3), " s, ", fixed(steps.largest_gap_at_s, 3),
                 " s after the first\n");
  } else if (s.count > 1) {
    line += "  gaps: none above 1.5 periods\n";
  }
  if (steps.backwards > 0) line += text("  TIME GOES BACKWARDS ", steps.backwards, " times\n");
  if (s.without_stamp > 0) line += text("  WITHOUT A STAMP: ", s.without_stamp, '\n');
  return line;
}

std::string scanLines(const SensorInfo& s) {
  std::string lines;
  if (!s.points.empty()) {
    const Spread points = spreadOf(s.points);
    lines += text("  points a scan: ", points.min, " / ", points.median, " / ", points.max,
                  " (min / median / max), with point times ", s.with_point_times, " of ",
                  s.points.size(), ", deskewed ", s.deskewed, '\n');
  }
  for (const auto& [policy, count] : s.time_policies)
    lines += text("  ", policy, " (scans: ", count, ")\n");
  for (const auto& [reason, count] : s.unreadable)
    lines += text("  CANNOT BE READ: ", count, ": ", reason, '\n');
  return lines;
}

}  // namespace

std::string tableOf(const RecordingInfo& info) {
  std::string table = text(info.file, ": ", fixed(static_cast<double>(info.bytes) / 1e6, 1),
                           " MB, ", info.objects, " objects\n");
  for (const SensorInfo& s : info.sensors) {
    table +=
        text('\n', s.class_name, s.label.empty() ? " (no label)" : text(" '", s.label, "'"), '\n');
    table += timesLine(s);
    table += scanLines(s);
  }
  if (!info.damage.empty()) table += text("\nDAMAGED: ", info.damage, '\n');
  return table;
}

nlohmann::json jsonOf(const RecordingInfo& info) {
  nlohmann::json sensors = nlohmann::json::array();
  for (const SensorInfo& s : info.sensors) {
    const StampSteps steps = stepsOf(s);
    nlohmann::json sensor = {{"class", s.class_name},
                             {"label", s.label},
                             {"count", s.count},
                             {"rate_hz", steps.period_s > 0 ? 1 / steps.period_s : 0},
                             {"mean_rate_hz", meanRate(s, steps)},
                             {"duration_s", steps.span_s},
                             {"gaps",
                              {{"count", steps.gaps},
                               {"largest_s", steps.largest_gap_s},
                               {"largest_at_s", steps.largest_gap_at_s}}},
                             {"backwards", steps.backwards},
                             {"without_stamp", s.without_stamp}};
    if (const auto first = firstStamp(s)) {
      sensor["first_s"] = secondsText(*first);
      sensor["last_s"] = secondsText(*std::max_element(s.stamps.begin(), s.stamps.end()));
    }
    if (!s.points.empty()) {
      const Spread points = spreadOf(s.points);
      sensor["points"] = {{"min", points.min}, {"median", points.median}, {"max", points.max}};
      sensor["with_point_times"] = s.with_point_times;
      sensor["deskewed"] = s.deskewed;
      sensor["time_policies"] = s.time_policies;
    }
    if (!s.unreadable.empty()) sensor["unreadable"] = s.unreadable;
    sensors.push_back(std::move(sensor));
  }
  return {{"file", info.file},
          {"bytes", info.bytes},
          {"objects", info.objects},
          {"damaged", info.damage},
          {"sensors", sensors}};
}

}  // namespace paloc
