#include "recorded_odometry.h"

// How the recorded odometry makes the estimator's scan of a LiDAR's.
namespace paloc {

std::shared_ptr<const Scan> RecordedOdometry::makeScan(const LidarFrame& frame) {
  unused_.add(frame.class_name, frame.label, "points without a valid return", frame.invalid_points);
  if (frame.points_lidar.empty()) {
    unused_.add(frame.class_name, frame.label, "scan without a point");
    return nullptr;
  }
  const RangeLimits limits{settings_.min_range_m, settings_.max_range_m};
  DroppedPoints dropped;
  auto scan =
      std::make_shared<Scan>(canDeskew(frame) ? deskew(frame, motionDuring(frame), limits, dropped)
                                              : placeOnBody(frame, limits, dropped));
  countDropped(frame, dropped);
  if (scan->points_body.empty()) {
    unused_.add(frame.class_name, frame.label, "scan without a point within range");
    return nullptr;
  }
  return scan;
}

void RecordedOdometry::countDropped(const LidarFrame& frame, const DroppedPoints& dropped) {
  unused_.add(frame.class_name, frame.label, "points nearer than min_range_m", dropped.too_near);
  unused_.add(frame.class_name, frame.label, "points beyond max_range_m", dropped.too_far);
}

bool RecordedOdometry::canDeskew(const LidarFrame& frame) {
  if (frame.deskewed || frame.duration_ns == 0) return false;
  if (!settings_.deskew) {
    note("scans are not deskewed, as the settings say");
    return false;
  }
  if (frame.dt_ns.empty()) {
    unused_.add(frame.class_name, frame.label, "not deskewed: no time for each point");
    return false;
  }
  return true;
}

ScanMotion RecordedOdometry::motionDuring(const LidarFrame& frame) {
  ScanMotionInput input;
  input.start_ns = frame.stamp_ns;
  input.end_ns = frame.endNs();
  input.imu = imu_samples_.covering(input.start_ns, input.end_ns);
  input.up_body_end = imu_samples_.upAt(input.end_ns);
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
    unused_.add(frame.class_name, frame.label,
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
