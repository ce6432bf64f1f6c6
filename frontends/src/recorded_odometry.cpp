#include "recorded_odometry.h"

#include <algorithm>
#include <cmath>

#include "event_queue.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/tum_file.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

OdometryLimits limitsOf(const FrontendSettings& settings) {
  return {settings.max_odometry_gap_s, settings.max_odometry_speed_mps,
          settings.max_odometry_rate_radps, settings.max_odometry_extrapolation_s};
}

}  // namespace

RecordedOdometry::RecordedOdometry(const FrontendSettings& settings)
    : settings_(settings),
      intake_(settings),
      odometry_("odometry", settings.odometry_label),
      track_(limitsOf(settings)) {
  if (!settings_.odometry_file.empty()) readOdometryFile();
}

void RecordedOdometry::readOdometryFile() {
  for (const StampedPose& stamped : readTum(settings_.odometry_file)) {
    const std::string problem = odometry_order_.check(stamped.t_ns);
    if (problem.empty()) {
      track_.add({stamped.t_ns, stamped.pose, std::nullopt});
    } else {
      intake_.unused().add("pose of the odometry file", settings_.odometry_file, problem);
    }
  }
}

void RecordedOdometry::add(const mrpt::obs::CObservation& observation) {
  if (isOdometry(observation)) {
    addOdometry(observation);
  } else if (!intake_.add(observation)) {
    intake_.skip(observation, "not a LiDAR, IMU or odometry");
  }
  giveOutWhatIsReady();
}

void RecordedOdometry::addOdometry(const mrpt::obs::CObservation& observation) {
  if (!settings_.odometry_file.empty()) {
    return intake_.skip(observation, "an odometry file is used instead");
  }
  if (!odometry_.takes(classNameOf(observation), observation.sensorLabel)) {
    return intake_.skip(observation, "another odometry is used");
  }
  std::string problem;
  const auto pose = decodeOdometry(observation, problem);
  if (pose) problem = odometry_order_.check(pose->t_ns);
  if (!problem.empty()) return intake_.skip(observation, problem);
  track_.add(*pose);
  intake_.reached(pose->t_ns);
}

bool RecordedOdometry::reaches(TimeNs t_ns) const {
  return !settings_.odometry_file.empty() || (!track_.empty() && track_.newestNs() >= t_ns);
}

void RecordedOdometry::giveOutWhatIsReady() {
  while (const LidarFrame* frame = intake_.readyScan([this](TimeNs t) { return reaches(t); })) {
    giveOutFrame(*frame);
    intake_.popScan();
  }
  if (const auto until_ns = intake_.imuReleaseNs()) giveOutImu(*until_ns);
}

void RecordedOdometry::giveOutImu(TimeNs until_ns) {
  while (auto sample = intake_.imu().takeUntil(until_ns)) events_.emplace_back(*sample);
}

void RecordedOdometry::giveOutFrame(const LidarFrame& frame) {
  const TimeNs end = frame.endNs();
  giveOutImu(end);
  OdometryFrame result;
  result.t_ns = end;
  placeInOdometry(result);
  result.scan = scanOf(frame);
  ++counts_.frames;
  counts_.with_scan += result.scan != nullptr;
  events_.emplace_back(std::move(result));
  intake_.imu().forgetBefore(frame.stamp_ns);
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
  if (intake_.finished()) return;
  intake_.finish();
  giveOutWhatIsReady();
  if (!intake_.imu().empty()) giveOutImu(intake_.imu().newestNs());
  noteAtEnd();
}

std::optional<FrontendEvent> RecordedOdometry::next() { return takeFront(events_); }

std::vector<std::string> RecordedOdometry::problems() const {
  std::vector<std::string> sentences = intake_.problems();
  for (const std::string& sentence : {odometry_.problem(), intake_.whyNoScan(counts_.with_scan)}) {
    if (!sentence.empty()) sentences.push_back(sentence);
  }
  return sentences;
}

void RecordedOdometry::noteAtEnd() {
  intake_.noteStreams();
  intake_.note(odometry_.remark());
  if (!intake_.hasLidar()) return;  // the rest is about what helps its scans
  const bool imu = !intake_.imu().empty(), odometry = !track_.empty();
  if (!imu && !odometry) {
    intake_.note(
        "the recording has neither IMU nor odometry that can be used: nothing tells the motion "
        "between scans");
  } else if (!imu) {
    intake_.note(
        "there is no IMU that can be used: the motion within a scan is taken from the odometry "
        "alone");
  } else if (!odometry) {
    intake_.note(
        "there is no odometry that can be used: scans are deskewed by rotation only, and the "
        "motion "
        "between them rests on the IMU");
  }
  intake_.noteImuGaps();
  if (track_.gaps() > 0) {
    intake_.note("the odometry pauses for more than " +
                 figure("%g s ", settings_.max_odometry_gap_s) + timesInFigures(track_.gaps()) +
                 figure(", at most %.3f s", track_.longestGapS()));
  }
  if (track_.jumps() > 0) {
    intake_.note("the odometry jumps " + timesInFigures(track_.jumps()) + ": a step faster than " +
                 figure("%g m/s or ", settings_.max_odometry_speed_mps) +
                 figure("%g rad/s is taken for a reset", settings_.max_odometry_rate_radps));
  }
  noteScans();
}

void RecordedOdometry::noteScans() {
  const bool imu = !intake_.imu().empty(), odometry = !track_.empty();
  const auto scans = [this](int count) {
    return std::to_string(count) + " of " + std::to_string(counts_.frames) + " scans";
  };
  if (odometry && counts_.without_pose > 0) {
    intake_.note(scans(counts_.without_pose) +
                 " end where the odometry does not reach, and come without its pose");
  }
  if (counts_.extrapolated > 0) {
    intake_.note(scans(counts_.extrapolated) + " end up to " +
                 figure("%g s", settings_.max_odometry_extrapolation_s) +
                 " after the last pose of the odometry, which is carried on at even speed");
  }
  if (odometry && counts_.coasted > 0) {
    intake_.note(
        scans(counts_.coasted) +
        " are deskewed without odometry: by the gyroscope, and the last velocity if known");
  }
  if (imu && counts_.by_odometry_alone > 0) {
    intake_.note(scans(counts_.by_odometry_alone) +
                 " are deskewed by the odometry alone, as the IMU does not cover them");
  }
}

}  // namespace paloc
