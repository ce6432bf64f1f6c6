#include "paloc/frontends/imu_reader.h"

#include <array>

#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/mrpt_time.h"

namespace paloc {

std::optional<ImuSample> decodeImu(const mrpt::obs::CObservationIMU& observation,
                                   std::string& refusal) {
  using namespace mrpt::obs;
  constexpr double kLargestLeverArm = 1e-6;  // m
  // By name: the class stores the rates in the order z, y, x.
  constexpr std::array<TIMUDataIndex, 6> kFields = {IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC,
                                                    IMU_WX,    IMU_WY,    IMU_WZ};
  for (const auto field : kFields) {
    if (!observation.has(field)) {
      refusal = "no accelerometer or gyroscope values";
      return std::nullopt;
    }
  }
  const Pose T_body_sensor = fromMrpt(observation.sensorPose);
  if (!(T_body_sensor.position.norm() < kLargestLeverArm)) {
    refusal = "IMU away from the body's origin (the body frame is the IMU's)";
    return std::nullopt;
  }
  const auto vector = [&](TIMUDataIndex x, TIMUDataIndex y, TIMUDataIndex z) {
    return Vec3(T_body_sensor.rotation *
                Vec3(observation.get(x), observation.get(y), observation.get(z)));
  };
  ImuSample sample;
  sample.t_ns = fromMrptTime(observation.timestamp);
  sample.acc_body = vector(IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC);
  sample.omega_body = vector(IMU_WX, IMU_WY, IMU_WZ);
  if (!sample.acc_body.allFinite() || !sample.omega_body.allFinite()) {
    refusal = "not finite";
    return std::nullopt;
  }
  return sample;
}

}  // namespace paloc
