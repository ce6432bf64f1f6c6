#pragma once

namespace paloc {

/// Noise of an IMU, from its data sheet. Defaults: a good tactical MEMS unit with a margin.
struct ImuNoise {
  double accelerometer_noise_density_mps2_sqrthz = 2e-3;
  double gyroscope_noise_density_radps_sqrthz = 1e-4;
  double accelerometer_bias_walk_mps3_sqrthz = 1e-4;
  double gyroscope_bias_walk_radps2_sqrthz = 1e-5;
};

}  // namespace paloc
