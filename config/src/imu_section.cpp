#include "section.h"

namespace paloc {

std::vector<Setting> imuSettings() {
  using S = ImuNoise;
  Section s(
      "imu", [](auto& config) -> auto& { return config.estimator.imu; });
  s.number("accelerometer_noise_density_mps2_sqrthz", &S::accelerometer_noise_density_mps2_sqrthz,
           "m/s2/sqrt(Hz)", {1e-7, 10}, "White noise of the accelerometer, from the data sheet.");
  s.number("gyroscope_noise_density_radps_sqrthz", &S::gyroscope_noise_density_radps_sqrthz,
           "rad/s/sqrt(Hz)", {1e-9, 1}, "White noise of the gyroscope, from the data sheet.");
  s.number("accelerometer_bias_walk_mps3_sqrthz", &S::accelerometer_bias_walk_mps3_sqrthz,
           "m/s3/sqrt(Hz)", {1e-9, 10}, "Random walk of the accelerometer's bias.");
  s.number("gyroscope_bias_walk_radps2_sqrthz", &S::gyroscope_bias_walk_radps2_sqrthz,
           "rad/s2/sqrt(Hz)", {1e-11, 1}, "Random walk of the gyroscope's bias.");
  return std::move(s).rows();
}

}  // namespace paloc
