#pragma once

#include "paloc/core/imu_noise.h"
#include "paloc/core/imu_sample.h"
#include "paloc/core/pose.h"

namespace paloc {

/// IMU measurements between two nodes, summed up once on the manifold: Forster et al., "On-Manifold
/// Preintegration for Real-Time Visual-Inertial Odometry" (2017), section VI. Within a step the
/// body rates are taken as constant and integrated exactly.
///
/// Error state and covariance (9): [position, rotation on the right, velocity], in the body frame
/// of the start.
class PALOC_EXPORT Preintegration {
 public:
  /// `bias_acc` (m/s2) and `bias_gyro` (rad/s): where the first-order bias correction is expanded.
  Preintegration(const ImuNoise& noise, const Vec3& bias_acc, const Vec3& bias_gyro);

  /// Adds a step of constant specific force (m/s2) and rate (rad/s). Steps with dt_s <= 0 change
  /// nothing.
  void integrate(const Vec3& acc_body, const Vec3& omega_body, double dt_s);

  using Covariance = Eigen::Matrix<double, 9, 9>;

  double dt_s = 0;
  Vec3 delta_p =
      Vec3::Zero();  ///< m, body frame of the start, without gravity and initial velocity
  Mat3 delta_R = Mat3::Identity();
  Vec3 delta_v = Vec3::Zero();  ///< m/s
  Covariance covariance = Covariance::Zero();

  Vec3 bias_acc, bias_gyro;
  // Derivatives with respect to the biases, at bias_acc and bias_gyro.
  Mat3 dp_dbias_acc = Mat3::Zero(), dp_dbias_gyro = Mat3::Zero();
  Mat3 dv_dbias_acc = Mat3::Zero(), dv_dbias_gyro = Mat3::Zero();
  Mat3 dR_dbias_gyro = Mat3::Zero();  ///< delta_R(b + d) = delta_R Exp(dR_dbias_gyro d)

 private:
  void propagateCovariance(const Mat3& p_by_rotation, const Mat3& v_by_rotation, const Mat3& step_R,
                           const Mat3& step_Jr, double dt);

  double acc_noise_density_sq_, gyro_noise_density_sq_;
};

}  // namespace paloc
