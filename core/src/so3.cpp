#include "paloc/core/so3.h"

#include <cmath>
#include <numbers>

namespace paloc::so3 {
namespace {

// Below this squared angle (rad2) the closed forms lose digits to cancellation: series are used.
constexpr double kSmallAngleSq = 1e-8;

}  // namespace

Mat3 hat(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Mat3 exp(const Vec3& w) {
  const double angle_sq = w.squaredNorm();
  double a = 0, b = 0;  // R = I + a hat(w) + b hat(w)^2
  if (angle_sq < kSmallAngleSq) {
    a = 1 - angle_sq / 6;
    b = 0.5 - angle_sq / 24;
  } else {
    const double angle = std::sqrt(angle_sq);
    const double half_sine = std::sin(0.5 * angle);
    a = std::sin(angle) / angle;
    b = 2 * half_sine * half_sine / angle_sq;  // (1 - cos) without cancellation
  }
  const Mat3 w_hat = hat(w);
  return Mat3::Identity() + a * w_hat + b * (w_hat * w_hat);
}

Vec3 log(const Mat3& rotation) {
  // By way of the unit quaternion: accurate everywhere, where the trace is not near pi.
  const Eigen::Quaterniond q(rotation);
  const double sine = q.vec().norm();  // of half the angle
  if (sine < 1e-5) {
    // atan(s / w) / s = (1 - s^2 / (3 w^2)) / w + O(s^4)
    const double w = q.w();
    return (2 / w) * (1 - sine * sine / (3 * w * w)) * q.vec();
  }
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  return (2 * std::atan2(sine, sign * q.w()) * sign / sine) * q.vec();
}

Mat3 rightJacobian(const Vec3& w) {
  const double angle_sq = w.squaredNorm();
  double b = 0, c = 0;  // J = I - b hat(w) + c hat(w)^2
  if (angle_sq < kSmallAngleSq) {
    b = 0.5 - angle_sq / 24;
    c = 1.0 / 6 - angle_sq / 120;
  } else {
    const double angle = std::sqrt(angle_sq);
    const double half_sine = std::sin(0.5 * angle);
    b = 2 * half_sine * half_sine / angle_sq;
    c = (angle - std::sin(angle)) / (angle_sq * angle);
  }
  const Mat3 w_hat = hat(w);
  return Mat3::Identity() - b * w_hat + c * (w_hat * w_hat);
}

Mat3 rightJacobianInverse(const Vec3& w) {
  const double angle_sq = w.squaredNorm();
  double c = 0;  // J^-1 = I + hat(w) / 2 + c hat(w)^2
  if (angle_sq < kSmallAngleSq) {
    c = 1.0 / 12 + angle_sq / 720;
  } else {
    const double angle = std::sqrt(angle_sq);
    c = 1 / angle_sq - 0.5 / (angle * std::tan(0.5 * angle));
  }
  const Mat3 w_hat = hat(w);
  return Mat3::Identity() + 0.5 * w_hat + c * (w_hat * w_hat);
}

Mat3 normalized(const Mat3& rotation) {
  return Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
}

}  // namespace paloc::so3
