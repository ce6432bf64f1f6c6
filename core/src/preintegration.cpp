#include "paloc/core/preintegration.h"

namespace paloc {
namespace {

// The double integral of Exp(w s) over the unit interval, as a series: steps turn by milliradians.
Mat3 doubleIntegralOfRotation(const Vec3& w) {
  const Mat3 w_hat = so3::hat(w);
  return 0.5 * Mat3::Identity() + w_hat / 6 + (w_hat * w_hat) / 24 + (w_hat * w_hat * w_hat) / 120;
}

}  // namespace

Preintegration::Preintegration(const ImuNoise& noise, const Vec3& bias_acc_in,
                               const Vec3& bias_gyro_in)
    : bias_acc(bias_acc_in),
      bias_gyro(bias_gyro_in),
      acc_noise_density_sq_(noise.accelerometer_noise_density_mps2_sqrthz *
                            noise.accelerometer_noise_density_mps2_sqrthz),
      gyro_noise_density_sq_(noise.gyroscope_noise_density_radps_sqrthz *
                             noise.gyroscope_noise_density_radps_sqrthz) {}

void Preintegration::integrate(const Vec3& acc_body, const Vec3& omega_body, double dt) {
  if (!(dt > 0)) return;
  const Vec3 acc = acc_body - bias_acc;
  const Vec3 turn = (omega_body - bias_gyro) * dt;
  const Mat3 step_R = so3::exp(turn);
  const Mat3 step_Jr = so3::rightJacobian(turn);
  // The step's velocity and displacement per unit of force, in its first body frame.
  const Mat3 integral = step_Jr.transpose() * dt;  // left Jacobian = right one transposed
  const Mat3 double_integral = doubleIntegralOfRotation(turn) * (dt * dt);
  const Vec3 step_v = integral * acc, step_p = double_integral * acc;
  // By an error of the rotation before the step.
  const Mat3 v_by_rotation = -delta_R * so3::hat(step_v);
  const Mat3 p_by_rotation = -delta_R * so3::hat(step_p);

  propagateCovariance(p_by_rotation, v_by_rotation, step_R, step_Jr, dt);

  // By the turn within the step, to first order in it: with u = turn,
  // d(integral a) = -(hat(a) / 2 + (hat(u) hat(a) + hat(u x a)) / 6 + ..) du.
  const Mat3 acc_hat = so3::hat(acc);
  const Mat3 curl = so3::hat(turn) * acc_hat + so3::hat(turn.cross(acc));
  dp_dbias_gyro += dv_dbias_gyro * dt + p_by_rotation * dR_dbias_gyro +
                   (dt * dt * dt) * (delta_R * (acc_hat / 6 + curl / 24));
  dv_dbias_gyro += v_by_rotation * dR_dbias_gyro + (dt * dt) * (delta_R * (acc_hat / 2 + curl / 6));
  dp_dbias_acc += dv_dbias_acc * dt - delta_R * double_integral;
  dv_dbias_acc -= delta_R * integral;
  dR_dbias_gyro = step_R.transpose() * dR_dbias_gyro - step_Jr * dt;

  delta_p += delta_v * dt + delta_R * step_p;
  delta_v += delta_R * step_v;
  delta_R = delta_R * step_R;
  dt_s += dt;
}

// A: position by rotation, C: velocity by rotation.
void Preintegration::propagateCovariance(const Mat3& A, const Mat3& C, const Mat3& step_R,
                                         const Mat3& step_Jr, double dt) {
  // Error of the step in terms of the error before it and of the sample's white noise; by blocks of
  // F = [I A dt; 0 B 0; 0 C I], since most of the 9 x 9 matrix is zero.
  const Mat3 B = step_R.transpose();  // rotation by rotation
  Covariance left;                    // F P
  left.topRows<3>() =
      covariance.topRows<3>() + A * covariance.middleRows<3>(3) + dt * covariance.bottomRows<3>();
  left.middleRows<3>(3) = B * covariance.middleRows<3>(3);
  left.bottomRows<3>() = covariance.bottomRows<3>() + C * covariance.middleRows<3>(3);
  covariance.leftCols<3>() =
      left.leftCols<3>() + left.middleCols<3>(3) * A.transpose() + dt * left.rightCols<3>();
  covariance.middleCols<3>(3) = left.middleCols<3>(3) * B.transpose();
  covariance.rightCols<3>() = left.rightCols<3>() + left.middleCols<3>(3) * C.transpose();

  // White noise of density s integrated over the step, once for velocity, twice for position: the
  // exact moments, so that even a single step leaves a positive definite covariance.
  const double acc_variance = acc_noise_density_sq_ * dt;
  covariance.block<3, 3>(3, 3) += gyro_noise_density_sq_ * dt * step_Jr * step_Jr.transpose();
  covariance.block<3, 3>(0, 0).diagonal().array() += acc_variance * dt * dt / 3;
  covariance.block<3, 3>(0, 6).diagonal().array() += acc_variance * dt / 2;
  covariance.block<3, 3>(6, 0).diagonal().array() += acc_variance * dt / 2;
  covariance.block<3, 3>(6, 6).diagonal().array() += acc_variance;
}

}  // namespace paloc
