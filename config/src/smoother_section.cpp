#include "section.h"

namespace paloc {

std::vector<Setting> smootherSettings() {
  using S = SmootherSettings;
  Section s(
      "smoother", [](auto& config) -> auto& { return config.estimator.smoother; });
  s.number("lag_s", &S::lag_s, "s", {0.1, 600},
           "States further than this behind the newest are marginalized.");
  s.number("relinearize_position_m", &S::relinearize_position_m, "m", {0, 100},
           "A state that moved further from its linearization point gets a new one.");
  s.number("relinearize_rotation_rad", &S::relinearize_rotation_rad, "rad", {0, 4},
           "Likewise for its rotation.");
  s.number("relinearize_velocity_mps", &S::relinearize_velocity_mps, "m/s", {0, 100},
           "Likewise for its velocity.");
  s.number("relinearize_bias_acc_mps2", &S::relinearize_bias_acc_mps2, "m/s2", {0, 10},
           "Likewise for its accelerometer bias.");
  s.number("relinearize_bias_gyro_radps", &S::relinearize_bias_gyro_radps, "rad/s", {0, 10},
           "Likewise for its gyroscope bias.");
  s.number("relinearize_gravity", &S::relinearize_gravity, "", {0, 2},
           "Likewise for its direction of gravity, a unit vector.");
  s.count("max_relinearizations", &S::max_relinearizations, {1, 100},
          "Rounds of relinearization within one update.");
  s.flag("covariance_of_leaving", &S::covariance_of_leaving,
         "Compute the covariance of states that leave the window.");
  s.count("batch_max_iterations", &S::batch_max_iterations, {1, 10000},
          "Iterations of the batch smoother at the end of the recording.");
  s.number("batch_convergence", &S::batch_convergence, "", {0, 1},
           "Relative decrease of the cost below which the batch smoother has converged.");
  return std::move(s).rows();
}

}  // namespace paloc
