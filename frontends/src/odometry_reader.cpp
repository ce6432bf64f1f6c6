#include "paloc/frontends/odometry_reader.h"

#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/mrpt_time.h"

namespace paloc {
namespace {

using mrpt::obs::CObservationOdometry;
using mrpt::obs::CObservationRobotPose;

// From an error of the sensor's pose to that of the body's: p_b = p_s + R_s t, R_b = R_s R, with
// T_sensor_body = (R, t).
Mat6 bodyCovariance(const Mat6& sensor_covariance, const Mat3& R_odom_sensor,
                    const Pose& T_sensor_body) {
  Mat6 j = Mat6::Zero();
  j.topLeftCorner<3, 3>().setIdentity();
  j.topRightCorner<3, 3>() = -R_odom_sensor * so3::hat(T_sensor_body.position);
  j.bottomRightCorner<3, 3>() = T_sensor_body.rotation.transpose();
  return j * sensor_covariance * j.transpose();
}

bool readRobotPose(const CObservationRobotPose& observation, OdometryPose& result,
                   std::string& refusal) {
  const Pose T_odom_sensor = fromMrpt(observation.pose.mean);
  const Pose T_sensor_body = fromMrpt(observation.sensorPose).inverse();
  result.T_odom_body = T_odom_sensor * T_sensor_body;
  bool all_zero = true;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) all_zero = all_zero && observation.pose.cov(i, k) == 0;
  }
  if (all_zero) return true;
  const Mat6 covariance = tangentCovariance(observation.pose);
  if (!covariance.allFinite() || !(covariance.diagonal().minCoeff() >= 0)) {
    refusal = "its covariance is not finite or has a negative variance";
    return false;
  }
  result.step_covariance = bodyCovariance(covariance, T_odom_sensor.rotation, T_sensor_body);
  return true;
}

}  // namespace

bool isOdometry(const mrpt::obs::CObservation& observation) {
  return dynamic_cast<const CObservationRobotPose*>(&observation) ||
         dynamic_cast<const CObservationOdometry*>(&observation);
}

std::optional<OdometryPose> decodeOdometry(const mrpt::obs::CObservation& observation,
                                           std::string& refusal) {
  OdometryPose result;
  result.t_ns = fromMrptTime(observation.timestamp);
  if (const auto* pose = dynamic_cast<const CObservationRobotPose*>(&observation)) {
    if (!readRobotPose(*pose, result, refusal)) return std::nullopt;
  } else if (const auto* planar = dynamic_cast<const CObservationOdometry*>(&observation)) {
    result.T_odom_body = fromMrpt(mrpt::poses::CPose3D(planar->odometry));
  } else {
    refusal = "not an odometry";
    return std::nullopt;
  }
  if (!result.T_odom_body.position.allFinite() || !result.T_odom_body.rotation.allFinite()) {
    refusal = "not finite";
    return std::nullopt;
  }
  return result;
}

}  // namespace paloc
