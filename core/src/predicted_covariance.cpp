#include "paloc/core/predicted_covariance.h"

#include <algorithm>
#include <numbers>

namespace paloc {
namespace {

constexpr double kTurn_radps = 1.0;   // of a platform that nothing watches
constexpr double kUnknownMotion = 1;  // m, rad: far above what an IMU leaves unknown

}  // namespace

Mat6 unmeasuredMotion(double dt_s, const EstimatorSettings& settings) {
  const double position = settings.prior_sigma_velocity_mps * dt_s;
  const double rotation = std::min(kTurn_radps * dt_s, std::numbers::pi);
  Vec6 variances;
  variances << Vec3::Constant(position * position), Vec3::Constant(rotation * rotation);
  return variances.asDiagonal();
}

Mat6 independentMotion(const OdometryFrame& frame) {
  return frame.motion_covariance + kUnknownMotion * kUnknownMotion * frame.open_motion;
}

Mat6 predictedCovariance(const StateMatrix& last, double dt_s, MotionSource source,
                         const EstimatorSettings& settings) {
  using namespace tangent;
  Mat6 covariance = last.topLeftCorner<6, 6>();
  if (source == MotionSource::kNone) covariance += unmeasuredMotion(dt_s, settings);
  if (source != MotionSource::kImu) return covariance;
  const auto meanVariance = [&last](int offset) {
    return std::max(0.0, last.diagonal().segment<3>(offset).sum() / 3);
  };
  const double tilt_acc_sq =
      settings.gravity_mps2 * settings.gravity_mps2 * meanVariance(kRotation);
  const double half_dt_sq = 0.5 * dt_s * dt_s;
  covariance.topLeftCorner<3, 3>() +=
      dt_s * dt_s * last.block<3, 3>(kVelocity, kVelocity) +
      half_dt_sq * half_dt_sq * (meanVariance(kBiasAcc) + tilt_acc_sq) * Mat3::Identity();
  covariance.bottomRightCorner<3, 3>() += dt_s * dt_s * last.block<3, 3>(kBiasGyro, kBiasGyro);
  return covariance;
}

}  // namespace paloc
