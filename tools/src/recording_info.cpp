#include "paloc/tools/recording_info.h"

#include <algorithm>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/frontends/lidar_decoder.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/tools/quantile.h"

namespace paloc {
namespace {

std::string plainClassName(const mrpt::obs::CObservation& observation) {
  const std::string name = observation.GetRuntimeClass()->className;
  const std::size_t colon = name.rfind(':');
  return colon == std::string::npos ? name : name.substr(colon + 1);
}

void addScan(const mrpt::obs::CObservation& observation, SensorInfo& sensor) {
  std::string refusal;
  const auto frame = decodeLidar(observation, {}, refusal);
  if (!frame) {
    ++sensor.unreadable[refusal];
    return;
  }
  sensor.points.push_back(frame->points_lidar.size());
  sensor.with_point_times += frame->dt_ns.empty() ? 0 : 1;
  sensor.deskewed += frame->deskewed ? 1 : 0;
  if (!frame->time_policy.empty()) ++sensor.time_policies[frame->time_policy];
}

}  // namespace

StampSteps stepsOf(const SensorInfo& sensor) {
  constexpr double kGapFactor = 1.5;
  StampSteps result;
  if (sensor.stamps.empty()) return result;
  const auto [first, last] = std::minmax_element(sensor.stamps.begin(), sensor.stamps.end());
  result.span_s = secondsBetween(*first, *last);
  for (std::size_t i = 1; i < sensor.stamps.size(); ++i) {
    result.backwards += sensor.stamps[i] < sensor.stamps[i - 1] ? 1 : 0;
  }
  std::vector<TimeNs> sorted = sensor.stamps;
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    steps.push_back(secondsBetween(sorted[i - 1], sorted[i]));
  }
  result.period_s = quantile(steps, 0.5);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double step = steps[i];
    if (step <= kGapFactor * result.period_s) continue;
    ++result.gaps;
    if (step <= result.largest_gap_s) continue;
    result.largest_gap_s = step;
    result.largest_gap_at_s = secondsBetween(sorted.front(), sorted[i]);
  }
  return result;
}

RecordingInfo readRecordingInfo(const std::filesystem::path& file) {
  RawlogStream stream(file);
  std::map<std::pair<std::string, std::string>, SensorInfo> sensors;
  while (const auto observation = stream.next()) {
    const std::string class_name = plainClassName(*observation);
    SensorInfo& sensor = sensors[{class_name, observation->sensorLabel}];
    sensor.class_name = class_name;
    sensor.label = observation->sensorLabel;
    ++sensor.count;
    if (observation->timestamp == INVALID_TIMESTAMP) {
      ++sensor.without_stamp;
    } else {
      sensor.stamps.push_back(fromMrptTime(observation->timestamp));
    }
    if (isLidar(*observation)) addScan(*observation, sensor);
  }
  if (sensors.empty()) {
    throw IoError(stream.error().empty() ? text(file.string(), ": holds no observation")
                                         : stream.error());
  }
  RecordingInfo info;
  info.file = file.string();
  info.bytes = std::filesystem::file_size(file);
  info.objects = stream.objectsRead();
  info.damage = stream.error();
  for (auto& [key, sensor] : sensors) info.sensors.push_back(std::move(sensor));
  return info;
}

}  // namespace paloc
