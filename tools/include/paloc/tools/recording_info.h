#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "paloc/core/time.h"

namespace paloc {

/// What a recording holds of one sensor.
struct SensorInfo {
  std::string class_name, label;
  std::uint64_t count = 0;
  std::uint64_t without_stamp = 0;    ///< not among the stamps
  std::vector<TimeNs> stamps;         ///< in the order of the file
  std::vector<std::uint64_t> points;  ///< valid points a scan; empty for what is no LiDAR
  std::uint64_t with_point_times = 0, deskewed = 0;    ///< scans
  std::map<std::string, std::uint64_t> unreadable;     ///< scans that cannot be decoded, by reason
  std::map<std::string, std::uint64_t> time_policies;  ///< how point times are read, by scans
};

/// Steps between the stamps of a sensor.
struct StampSteps {
  double span_s = 0;
  double period_s = 0;          ///< median step; 0 if there is none
  std::uint64_t gaps = 0;       ///< steps longer than 1.5 periods
  double largest_gap_s = 0;     ///< the longest step; 0 if none is a gap
  double largest_gap_at_s = 0;  ///< its start, after the sensor's first stamp
  std::uint64_t backwards = 0;  ///< steps back in time
};

StampSteps stepsOf(const SensorInfo& sensor);

struct RecordingInfo {
  std::string file;
  std::uint64_t bytes = 0;
  std::uint64_t objects = 0;
  std::vector<SensorInfo> sensors;  ///< by class, then label
  std::string damage;               ///< one sentence; empty if the file is whole
};

/// Reads a whole rawlog. Throws IoError if there is not one observation in it.
RecordingInfo readRecordingInfo(const std::filesystem::path& file);

std::string tableOf(const RecordingInfo& info);
nlohmann::json jsonOf(const RecordingInfo& info);

}  // namespace paloc
