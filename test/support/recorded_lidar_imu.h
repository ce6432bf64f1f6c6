#pragma once

#include <memory>
#include <string>
#include <vector>

#include "recorded_walk.h"

/// Recordings of LiDAR and IMU on a path, for front-ends that need no other odometry.
namespace paloc::test::recorded {

inline double seconds(TimeNs t_ns) { return static_cast<double>(t_ns) * 1e-9; }

/// What a perfect IMU would measure on the path at that time.
inline std::shared_ptr<CObservationIMU> imuOn(const test::Path& path, TimeNs t) {
  const ImuSample sample = test::imuOnPath(path, t, 9.80665);
  auto imu = std::dynamic_pointer_cast<CObservationIMU>(imuAt(t));
  imu->set(mrpt::obs::IMU_X_ACC, sample.acc_body.x());
  imu->set(mrpt::obs::IMU_Y_ACC, sample.acc_body.y());
  imu->set(mrpt::obs::IMU_Z_ACC, sample.acc_body.z());
  imu->set(mrpt::obs::IMU_WX, sample.omega_body.x());
  imu->set(mrpt::obs::IMU_WY, sample.omega_body.y());
  imu->set(mrpt::obs::IMU_WZ, sample.omega_body.z());
  return imu;
}

/// Scans of a room by a sensor with 32 rings, which sees floor and ceiling, and the IMU, on a path.
inline std::vector<CObservation::Ptr> recordingOf(const test::Path& path, int scans,
                                                  bool with_imu = true) {
  Recording recording;
  for (int i = 0; i < scans; ++i) {
    recording.add(std::make_shared<obs::CObservationLidarScan>(
        test::scanRoom(test::BoxRoom{}, path, Pose{}, kT0 + i * kScan, kScan - kMs, 360, 32)));
  }
  const TimeNs end = kT0 + scans * kScan + 20 * kMs;
  for (TimeNs t = kT0 - 22 * kMs; with_imu && t <= end; t += 5 * kMs) {
    recording.add(imuOn(path, t));
  }
  return recording.inOrder();
}

/// Error of the motion between two frames.
inline Pose errorOf(const test::Path& path, const OdometryFrame& from, const OdometryFrame& to) {
  const Pose truth = path(seconds(from.t_ns)).inverse() * path(seconds(to.t_ns));
  const Pose motion = fromMrpt(from.T_odom_body).inverse() * fromMrpt(to.T_odom_body);
  return truth.inverse() * motion;
}

}  // namespace paloc::test::recorded
