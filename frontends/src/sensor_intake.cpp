#include "sensor_intake.h"

#include <algorithm>
#include <utility>

#include "paloc/frontends/imu_reader.h"
#include "sentence_parts.h"

namespace paloc {
std::string classNameOf(const mrpt::obs::CObservation& observation) {
  const std::string name = observation.GetRuntimeClass()->className;
  return name.substr(name.rfind(':') + 1);
}

SensorIntake::SensorIntake(const FrontendSettings& settings, LidarColumns columns)
    : settings_(settings),
      columns_(columns),
      lidar_("LiDAR", settings.lidar_label),
      imu_("IMU", settings.imu_label),
      imu_samples_(settings.max_imu_gap_s) {}

void SensorIntake::skip(const mrpt::obs::CObservation& observation, const std::string& reason) {
  unused_.add(classNameOf(observation), observation.sensorLabel, reason);
}

bool SensorIntake::add(const mrpt::obs::CObservation& observation) {
  if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation)) {
    addImu(*imu);
    return true;
  }
  if (!isLidar(observation)) return false;
  addLidar(observation);
  return true;
}

void SensorIntake::addImu(const mrpt::obs::CObservationIMU& observation) {
  if (!imu_.takes(classNameOf(observation), observation.sensorLabel)) {
    return skip(observation, "another IMU is used");
  }
  std::string problem;
  const auto sample = decodeImu(observation, problem);
  if (sample) problem = imu_order_.check(sample->t_ns);
  if (!problem.empty()) return skip(observation, problem);
  imu_samples_.add(*sample);
  reached(sample->t_ns);
}

void SensorIntake::addLidar(const mrpt::obs::CObservation& observation) {
  if (!lidar_.takes(classNameOf(observation), observation.sensorLabel)) {
    return skip(observation, "another LiDAR is used");
  }
  std::string problem;
  auto frame = decodeLidar(observation, columns_, problem, std::move(recycled_));
  recycled_ = {};
  if (frame) problem = lidar_order_.check(frame->stamp_ns);
  if (problem.empty() && last_end_ns_ && frame->endNs() <= *last_end_ns_) {
    problem = "ends no later than the scan before it";
  }
  if (!problem.empty()) return skip(observation, problem);
  last_end_ns_ = frame->endNs();
  reached(frame->stamp_ns);
  // Once for each way of reading: the duration varies a little from scan to scan.
  if (said_.insert("times of " + frame->label + ": " + frame->time_policy).second) {
    note("LiDAR '" + frame->label + "' (" + frame->class_name + "): " + frame->time_policy +
         (frame->duration_ns > 0
              ? figure(", %.1f ms a scan", static_cast<double>(frame->duration_ns) * 1e-6)
              : ""));
  }
  unused_.add(frame->class_name, frame->label, "points without a valid return",
              frame->invalid_points);
  waiting_.push_back(std::move(*frame));
}

LidarFrame* SensorIntake::readyScan(const std::function<bool(TimeNs)>& also_reaches) {
  if (waiting_.empty()) return nullptr;
  LidarFrame& frame = waiting_.front();
  const TimeNs end = frame.endNs();
  const bool imu = !imu_samples_.empty() && imu_samples_.newestNs() >= end;
  const bool late = secondsBetween(end, *newest_ns_) > settings_.max_wait_s;
  return finished_ || late || (imu && also_reaches(end)) ? &frame : nullptr;
}

bool SensorIntake::canDeskew(const LidarFrame& frame) {
  if (frame.deskewed || frame.duration_ns == 0) return false;
  if (!settings_.deskew) {
    note("scans are not deskewed, as the settings say");
    return false;
  }
  if (!frame.dt_ns.empty()) return true;
  unused_.add(frame.class_name, frame.label, "not deskewed: no time for each point");
  return false;
}

void SensorIntake::popScan() {
  recycled_ = std::move(waiting_.front());
  waiting_.pop_front();
}

std::optional<TimeNs> SensorIntake::imuReleaseNs() const {
  if (!waiting_.empty() || !newest_ns_ || finished_) return std::nullopt;
  return *newest_ns_ - nsFromSeconds(settings_.max_wait_s);
}

void SensorIntake::note(const std::string& sentence) {
  if (!sentence.empty() && said_.insert(sentence).second) notes_.push_back(sentence);
}

std::vector<std::string> SensorIntake::takeNotes() { return std::exchange(notes_, {}); }

void SensorIntake::noteStreams() {
  note(lidar_.remark());
  note(imu_.remark());
}

void SensorIntake::noteImuGaps() {
  if (imu_samples_.gaps() == 0) return;
  note("the IMU pauses for more than " + figure("%g s ", settings_.max_imu_gap_s) +
       timesInFigures(imu_samples_.gaps()) +
       figure(", at most %.3f s", imu_samples_.longestGapS()) +
       figure(", at t = %.3f s", static_cast<double>(imu_samples_.longestGapNs()) * 1e-9));
}

std::vector<std::string> SensorIntake::problems() const {
  std::vector<std::string> sentences;
  for (const StreamChoice* choice : {&lidar_, &imu_}) {
    if (const std::string sentence = choice->problem(); !sentence.empty()) {
      sentences.push_back(sentence);
    }
  }
  return sentences;
}

std::string SensorIntake::whyNoScan(int used) const {
  if (used > 0) return {};
  if (!lidar_.chosen()) {
    return settings_.lidar_label.empty() ? "the recording has no LiDAR scan" : "";
  }
  std::string reason;  // that of most scans; points are counted in rows of their own
  std::uint64_t most = 0;
  for (const UnusedCounts::Row& row : unused_.rows()) {
    const bool of_points = row.reason.starts_with("points ");
    if (!lidar_.isChosen(row.class_name, row.label) || of_points || row.count <= most) continue;
    most = row.count;
    reason = row.reason;
  }
  return "none of the LiDAR's scans could be used" + (reason.empty() ? "" : " (" + reason + ")");
}

}  // namespace paloc
