#include "make_scan.h"
#include "recorded_odometry.h"

// How the recorded odometry makes the estimator's scan of a LiDAR's.
namespace paloc {

std::shared_ptr<const Scan> RecordedOdometry::scanOf(const LidarFrame& frame) {
  const RangeLimits limits{settings_.min_range_m, settings_.max_range_m};
  if (frame.points_lidar.empty() || !intake_.canDeskew(frame)) {
    return makeScan(frame, nullptr, limits, intake_.unused());
  }
  const ScanMotion motion = motionDuring(frame);
  return makeScan(frame, &motion, limits, intake_.unused());
}

ScanMotion RecordedOdometry::motionDuring(const LidarFrame& frame) {
  ScanMotionInput input;
  input.start_ns = frame.stamp_ns;
  input.end_ns = frame.endNs();
  input.imu = intake_.imu().covering(input.start_ns, input.end_ns);
  input.up_body_end = intake_.imu().upAt(input.end_ns);
  const auto start = track_.at(input.start_ns), end = track_.at(input.end_ns);
  if (start && end && start->stretch == end->stretch) {
    input.odometry.push_back({input.start_ns, start->T_odom_body});
    for (const OdometryPose& pose : track_.between(input.start_ns, input.end_ns)) {
      input.odometry.push_back({pose.t_ns, pose.T_odom_body});
    }
    input.odometry.push_back({input.end_ns, end->T_odom_body});
  } else if (last_v_body_ &&
             secondsBetween(last_v_ns_, input.start_ns) <= settings_.max_odometry_gap_s) {
    input.v_body_start = last_v_body_;
  }
  if (input.odometry.empty() && input.imu.empty() && !input.v_body_start) {
    intake_.unused().add(frame.class_name, frame.label,
                         "not deskewed: neither IMU nor odometry cover the scan");
  } else {
    counts_.coasted += input.odometry.empty();
    counts_.by_odometry_alone += input.imu.empty();
  }
  const ScanMotion motion(input);
  last_v_body_ = motion.vBodyEnd();
  last_v_ns_ = motion.endNs();
  return motion;
}

}  // namespace paloc
