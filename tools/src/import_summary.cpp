#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/core/text.h"
#include "paloc/tools/import_recording.h"

namespace paloc {
namespace {

std::string row(const std::string& name, const std::string& value) {
  constexpr std::size_t kWidth = 22;
  return text("  ", name, std::string(name.size() < kWidth ? kWidth - name.size() : 1, ' '), value,
              '\n');
}

std::string fixed(double value, int decimals) {
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), "%.*f", decimals, value);
  return buffer;
}

}  // namespace

std::string tableOf(const ImportSummary& s) {
  std::string table = text(s.output, '\n');
  table += row("size", text(fixed(static_cast<double>(s.bytes) / 1e6, 1), " MB"));
  table += row("time span", text(fixed(s.duration_s, 3), " s"));
  table += row("scans", text(s.scans, ", ", s.points, " points; with point times ",
                             s.scans_with_times, ", taken as deskewed ", s.scans_deskewed));
  table += row("IMU samples", text(s.imu_samples));
  table += row("odometry poses", text(s.odometry_poses));
  for (const auto& [reason, count] : s.not_used) table += row("NOT USED", text(count, " ", reason));
  for (const auto& [reason, count] : s.noticed) table += row("noticed", text(count, " ", reason));
  for (const auto& note : s.notes) table += text("note: ", note, '\n');
  return table;
}

nlohmann::json jsonOf(const ImportSummary& s) {
  return {{"output", s.output},
          {"bytes", s.bytes},
          {"duration_s", s.duration_s},
          {"scans",
           {{"written", s.scans},
            {"points", s.points},
            {"with_point_times", s.scans_with_times},
            {"deskewed", s.scans_deskewed}}},
          {"imu_samples", s.imu_samples},
          {"odometry_poses", s.odometry_poses},
          {"not_used", s.not_used},
          {"noticed", s.noticed},
          {"notes", s.notes}};
}

}  // namespace paloc
