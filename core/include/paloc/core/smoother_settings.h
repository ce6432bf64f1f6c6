#pragma once

namespace paloc {

/// Settings of the fixed-lag and the batch smoother.
struct SmootherSettings {
  double lag_s = 5.0;  ///< nodes older than this behind the newest are marginalized

  // A node whose estimate moved further than this from its linearization point gets a new one.
  double relinearize_position_m = 0.05;
  double relinearize_rotation_rad = 0.005;
  double relinearize_velocity_mps = 0.2;
  double relinearize_bias_acc_mps2 = 0.05;
  double relinearize_bias_gyro_radps = 0.005;
  double relinearize_gravity = 0.005;
  int max_relinearizations = 3;  ///< rounds within one update

  bool covariance_of_leaving = true;  ///< compute it for nodes that leave the window

  int batch_max_iterations = 30;
  double batch_convergence = 1e-9;  ///< relative decrease of the cost below which it has converged
};

}  // namespace paloc
