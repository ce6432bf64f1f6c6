#include "recorded_odometry.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/imu_reader.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {
namespace {

std::string classNameOf(const mrpt::obs::CObservation& observation) {
  const std::string name = observation.GetRuntimeClass()->className;
  return name.substr(name.rfind(':') + 1);
}

OdometryLimits limitsOf(const FrontendSettings& settings) {
  return {settings.max_odometry_gap_s, settings.max_odometry_speed_mps,
          settings.max_odometry_rate_radps, settings.max_odometry_extrapolation_s};
}

std::string format(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

}  // namespace

RecordedOdometry::RecordedOdometry(const FrontendSettings& settings)
    : settings_(settings),
      lidar_("LiDAR", settings.lidar_label),
      imu_("IMU", settings.imu_label),
      odometry_("odometry", settings.odometry_label),
      imu_samples_(settings.max_imu_gap_s),
      track_(limitsOf(settings)) {
  if (!settings_.odometry_file.empty()) readOdometryFile();
}

void RecordedOdometry::readOdometryFile() {
  for (const StampedPose& stamped : readTum(settings_.odometry_file)) {
    const std::string problem = odometry_order_.check(stamped.t_ns);
    if (problem.empty()) {
      track_.add({stamped.t_ns, stamped.pose, std::nullopt});
    } else {
      unused_.add("pose of the odometry file", settings_.odometry_file, problem);
    }
  }
}

void RecordedOdometry::skip(const mrpt::obs::CObservation& observation, const std::string& reason) {
  unused_.add(classNameOf(observation), observation.sensorLabel, reason);
}

void RecordedOdometry::add(const mrpt::obs::CObservation& observation) {
  if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation)) {
    addImu(*imu);
  } else if (isOdometry(observation)) {
    addOdometry(observation);
  } else if (isLidar(observation)) {
    addLidar(observation);
  } else {
    skip(observation, "not a LiDAR, IMU or odometry");
  }
  giveOutWhatIsReady();
}

void RecordedOdometry::addImu(const mrpt::obs::CObservationIMU& observation) {
  if (!imu_.takes(classNameOf(observation), observation.sensorLabel)) {
    return skip(observation, "another IMU is used");
  }
  std::string problem;
  const auto sample = decodeImu(observation, problem);
  if (sample) problem = imu_order_.check(sample->t_ns);
  if (!problem.empty()) return skip(observation, problem);
  imu_samples_.add(*sample);
  newest_ns_ = std::max(newest_ns_.value_or(sample->t_ns), sample->t_ns);
}

void RecordedOdometry::addOdometry(const mrpt::obs::CObservation& observation) {
  if (!settings_.odometry_file.empty()) {
    return skip(observation, "an odometry file is used instead");
  }
  if (!odometry_.takes(classNameOf(observation), observation.sensorLabel)) {
    return skip(observation, "another odometry is used");
  }
  std::string problem;
  const auto pose = decodeOdometry(observation, problem);
  if (pose) problem = odometry_order_.check(pose->t_ns);
  if (!problem.empty()) return skip(observation, problem);
  track_.add(*pose);
  newest_ns_ = std::max(newest_ns_.value_or(pose->t_ns), pose->t_ns);
}

void RecordedOdometry::addLidar(const mrpt::obs::CObservation& observation) {
  if (!lidar_.takes(classNameOf(observation), observation.sensorLabel)) {
    return skip(observation, "another LiDAR is used");
  }
  std::string problem;
  auto frame = decodeLidar(observation, {}, problem, std::move(recycled_));
  recycled_ = {};
  if (frame) problem = lidar_order_.check(frame->stamp_ns);
  if (problem.empty() && last_end_ns_ && frame->endNs() <= *last_end_ns_) {
    problem = "ends no later than the scan before it";
  }
  if (!problem.empty()) return skip(observation, problem);
  last_end_ns_ = frame->endNs();
  newest_ns_ = std::max(newest_ns_.value_or(frame->stamp_ns), frame->stamp_ns);
  // Once for each way of reading: the duration varies a little from scan to scan.
  if (said_.insert("times of " + frame->label + ": " + frame->time_policy).second) {
    note("LiDAR '" + frame->label + "' (" + frame->class_name + "): " + frame->time_policy +
         (frame->duration_ns > 0
              ? format(", %.1f ms a scan", static_cast<double>(frame->duration_ns) * 1e-6)
              : ""));
  }
  waiting_.push_back(std::move(*frame));
}

bool RecordedOdometry::isReady(const LidarFrame& frame) const {
  const TimeNs end = frame.endNs();
  if (finished_ || secondsBetween(end, *newest_ns_) > settings_.max_wait_s) return true;
  const bool imu = !imu_samples_.empty() && imu_samples_.newestNs() >= end;
  const bool odometry =
      !settings_.odometry_file.empty() || (!track_.empty() && track_.newestNs() >= end);
  return imu && odometry;
}

void RecordedOdometry::giveOutWhatIsReady() {
  while (!waiting_.empty() && isReady(waiting_.front())) {
    giveOutFrame(waiting_.front());
    recycled_ = std::move(waiting_.front());
    waiting_.pop_front();
  }
  // Without a scan in sight samples are held no longer than a scan could be late.
  if (waiting_.empty() && newest_ns_ && !finished_) {
    giveOutImu(*newest_ns_ - nsFromSeconds(settings_.max_wait_s));
  }
}

void RecordedOdometry::giveOutImu(TimeNs until_ns) {
  while (auto sample = imu_samples_.takeUntil(until_ns)) events_.emplace_back(*sample);
}

void RecordedOdometry::giveOutFrame(LidarFrame& frame) {
  const TimeNs end = frame.endNs();
  giveOutImu(end);
  OdometryFrame result;
  result.t_ns = end;
  placeInOdometry(result);
  result.scan = makeScan(frame);
  ++counts_.frames;
  counts_.with_scan += result.scan != nullptr;
  events_.emplace_back(std::move(result));
  imu_samples_.forgetBefore(frame.stamp_ns);
  if (settings_.odometry_file.empty()) track_.forgetBefore(std::min(frame.stamp_ns, end));
}

void RecordedOdometry::placeInOdometry(OdometryFrame& result) {
  const auto found = track_.at(result.t_ns);
  if (!found) {
    ++counts_.without_pose;
    last_pose_.reset();
    return;
  }
  const FramePose now{result.t_ns, *found};
  counts_.extrapolated += found->extrapolated;
  result.T_odom_body = toMrpt(found->T_odom_body);
  result.continues = last_pose_ && last_pose_->odometry.stretch == found->stretch;
  if (result.continues) result.motion_covariance = motionCovariance(*last_pose_, now);
  last_pose_ = now;
}

Mat6 RecordedOdometry::motionCovariance(const FramePose& from, const FramePose& to) const {
  const auto square = [](double x) { return x * x; };
  Vec6 variance = Vec6::Zero();
  Mat6 covariance = Mat6::Zero();
  if (const auto told = track_.motionCovariance(from.t_ns, to.t_ns)) {
    covariance = *told;
    // Streams that are too sure, or say nothing of one direction, must not make it singular.
    variance << Vec3::Constant(square(1e-4)), Vec3::Constant(square(1e-5));
  } else {
    const Pose motion = from.odometry.T_odom_body.inverse() * to.odometry.T_odom_body;
    const double way = motion.position.norm(), angle = so3::log(motion.rotation).norm();
    variance << Vec3::Constant(square(settings_.odometry_sigma_position_floor_m) +
                               square(settings_.odometry_sigma_position_ratio * way)),
        Vec3::Constant(square(settings_.odometry_sigma_rotation_floor_rad) +
                       square(settings_.odometry_sigma_rotation_ratio * angle));
  }
  if (to.odometry.extrapolated) {
    // What a change of motion of 2 m/s2 and 2 rad/s2 would have made.
    constexpr double kChange = 2.0;
    const double dt_s = secondsBetween(std::min(track_.newestNs(), to.t_ns), to.t_ns);
    variance += Vec6::Constant(square(0.5 * kChange * dt_s * dt_s));
  }
  covariance.diagonal() += variance;
  return covariance;
}

void RecordedOdometry::finish() {
  if (finished_) return;
  finished_ = true;
  giveOutWhatIsReady();
  if (!imu_samples_.empty()) giveOutImu(imu_samples_.newestNs());
  noteAtEnd();
}

std::optional<FrontendEvent> RecordedOdometry::next() {
  if (events_.empty()) return std::nullopt;
  // Not a plain move of the variant: GCC 12 at -O3 then warns of an uninitialized member.
  auto event = std::visit([](auto& e) { return std::optional<FrontendEvent>(std::move(e)); },
                          events_.front());
  events_.pop_front();
  return event;
}

void RecordedOdometry::note(const std::string& sentence) {
  if (!sentence.empty() && said_.insert(sentence).second) notes_.push_back(sentence);
}

std::vector<std::string> RecordedOdometry::takeNotes() { return std::exchange(notes_, {}); }

std::vector<std::string> RecordedOdometry::problems() const {
  std::vector<std::string> sentences;
  for (const std::string& sentence :
       {lidar_.problem(), imu_.problem(), odometry_.problem(), whyNoScan()}) {
    if (!sentence.empty()) sentences.push_back(sentence);
  }
  return sentences;
}

std::string RecordedOdometry::whyNoScan() const {
  if (counts_.with_scan > 0) return {};
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

void RecordedOdometry::noteAtEnd() {
  for (const StreamChoice* choice : {&lidar_, &imu_, &odometry_}) note(choice->remark());
  if (!lidar_.chosen()) return;  // the rest is about what helps its scans
  const bool imu = !imu_samples_.empty(), odometry = !track_.empty();
  if (!imu && !odometry) {
    note(
        "the recording has neither IMU nor odometry that can be used: nothing tells the motion "
        "between scans");
  } else if (!imu) {
    note(
        "there is no IMU that can be used: the motion within a scan is taken from the odometry "
        "alone");
  } else if (!odometry) {
    note(
        "there is no odometry that can be used: scans are deskewed by rotation only, and the "
        "motion "
        "between them rests on the IMU");
  }
  const auto times = [](int count) {
    return std::to_string(count) + (count == 1 ? " time" : " times");
  };
  if (imu_samples_.gaps() > 0) {
    note("the IMU pauses for more than " + format("%g s ", settings_.max_imu_gap_s) +
         times(imu_samples_.gaps()) + format(", at most %.3f s", imu_samples_.longestGapS()) +
         format(", at t = %.3f s", static_cast<double>(imu_samples_.longestGapNs()) * 1e-9));
  }
  if (track_.gaps() > 0) {
    note("the odometry pauses for more than " + format("%g s ", settings_.max_odometry_gap_s) +
         times(track_.gaps()) + format(", at most %.3f s", track_.longestGapS()));
  }
  if (track_.jumps() > 0) {
    note("the odometry jumps " + times(track_.jumps()) + ": a step faster than " +
         format("%g m/s or ", settings_.max_odometry_speed_mps) +
         format("%g rad/s is taken for a reset", settings_.max_odometry_rate_radps));
  }
  const auto scans = [this](int count) {
    return std::to_string(count) + " of " + std::to_string(counts_.frames) + " scans";
  };
  if (odometry && counts_.without_pose > 0) {
    note(scans(counts_.without_pose) +
         " end where the odometry does not reach, and come without its pose");
  }
  if (counts_.extrapolated > 0) {
    note(scans(counts_.extrapolated) + " end up to " +
         format("%g s", settings_.max_odometry_extrapolation_s) +
         " after the last pose of the odometry, which is carried on at even speed");
  }
  if (odometry && counts_.coasted > 0) {
    note(scans(counts_.coasted) +
         " are deskewed without odometry: by the gyroscope, and the last velocity if known");
  }
  if (imu && counts_.by_odometry_alone > 0) {
    note(scans(counts_.by_odometry_alone) +
         " are deskewed by the odometry alone, as the IMU does not cover them");
  }
}

}  // namespace paloc
