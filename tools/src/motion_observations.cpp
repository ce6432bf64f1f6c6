#include "paloc/tools/motion_observations.h"

#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/mrpt_time.h"

namespace paloc {

mrpt::obs::CObservationIMU imuObservation(const ImuSample& sample, const std::string& label) {
  using namespace mrpt::obs;
  CObservationIMU imu;
  imu.timestamp = toMrptTime(sample.t_ns);
  imu.sensorLabel = label;
  imu.set(IMU_X_ACC, sample.acc_body.x());
  imu.set(IMU_Y_ACC, sample.acc_body.y());
  imu.set(IMU_Z_ACC, sample.acc_body.z());
  imu.set(IMU_WX, sample.omega_body.x());
  imu.set(IMU_WY, sample.omega_body.y());
  imu.set(IMU_WZ, sample.omega_body.z());
  return imu;
}

mrpt::obs::CObservationRobotPose poseObservation(const StampedPose& pose,
                                                 const std::string& label) {
  mrpt::obs::CObservationRobotPose observation;
  observation.timestamp = toMrptTime(pose.t_ns);
  observation.sensorLabel = label;
  observation.pose.mean = toMrpt(pose.pose);
  observation.pose.cov.setZero();  // unknown
  return observation;
}

}  // namespace paloc
