#include "paloc/frontends/feature_registration.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace paloc {
namespace {

constexpr double kLeastWidening = 0.01, kNarrowing = 0.3;  // m; a step
constexpr double kLeastGate = 0.1;                         // m
constexpr double kConvergedM = 3e-4, kConvergedRad = 1e-4;
constexpr std::size_t kMinRows = 20;
constexpr int kLookAgain = 2;  // iteration that asks anew what is informative

// From rotation on the left, as the sums have it, to the right.
void turnToRight(const Mat3& R, PointToPlaneSums<9>& sums) {
  Mat9 turn = Mat9::Identity();
  turn.block<3, 3>(lio::kRotation, lio::kRotation) = R;
  sums.information = (turn.transpose() * sums.information * turn).eval();
  sums.gradient = (turn.transpose() * sums.gradient).eval();
}

LioVector widened(const Vec9& step) {
  LioVector delta = LioVector::Zero();
  delta.head<9>() = step;
  return delta;
}

double displacementSigma(const Mat9& covariance, double lever_m) {
  const double position = covariance.diagonal().head<3>().sum();
  const double rotation = covariance.diagonal().segment<3>(lio::kRotation).sum();
  return std::sqrt(std::max(position + lever_m * lever_m * rotation, 0.0));
}

}  // namespace

std::size_t FeatureRegistration::match(const ScanFeatures& features, const FreeFallScan& scan,
                                       const Vec3& sensor_body, const KeyFrameMap& map,
                                       const LioState& x, double ageing, double gate_m) {
  placePoints(features.planes, scan, sensor_body, x, ageing, placed_);
  planes_.associate(placed_, map.planes(), gate_m);
  placePoints(features.edges, scan, sensor_body, x, ageing, placed_);
  lines_.associate(placed_, map.lines(), gate_m);
  return planes_.size() + lines_.size();
}

PointToPlaneSums<9> FeatureRegistration::sums(double widening_m, double ageing) {
  planes_.weigh(widening_m);
  lines_.weigh(widening_m);
  PointToPlaneSums<9> sums = planes_.sums<9>(ageing);
  lines_.addTo(sums, ageing);
  return sums;
}

FeatureMeasurement FeatureRegistration::align(const ScanFeatures& features,
                                              const FreeFallScan& scan, const Vec3& sensor_body,
                                              const KeyFrameMap& map, const LioState& predicted,
                                              const Mat9& covariance, bool rigid) {
  const double ageing = rigid ? 0 : 1;
  const double deviation = displacementSigma(covariance, rmsRange(features.planes));
  const double gate = std::min(limits_.max_gate_m, 3 * deviation + kLeastGate);
  double widening = std::min(deviation, gate);
  FeatureMeasurement result;
  result.at = result.found = predicted;
  result.points = features.planes.size() + features.edges.size();
  std::optional<InformativePart<9>> informative;
  bool converged = false;
  for (int i = 0; i < limits_.max_iterations && !converged; ++i) {
    LioState& x = result.found;
    result.matched = match(features, scan, sensor_body, map, x, ageing, gate);
    if (result.matched < kMinRows) {
      result.found = result.at = predicted;
      result.information.setZero();
      result.gradient.setZero();
      result.open = NullDirections<9>(9, 0);
      return result;
    }
    PointToPlaneSums<9> system = sums(widening, ageing);
    if (i == 0 || i == kLookAgain) {
      Mat9 noise = planes_.normalNoise<9>(ageing);
      lines_.addNoiseTo(noise, ageing);
      informative.emplace(system.information, noise);
      result.open = informative->open();
    }
    informative->apply(system);
    turnToRight(x.T_odom_body.rotation, system);
    result.at = x;
    result.information = system.information;
    result.gradient = system.gradient;
    // (P^-1 + H) d = P^-1 (prior - x) - gradient, times P: no inverse of a covariance is needed.
    const Mat9 left = Mat9::Identity() + covariance * system.information;
    const Vec9 right = boxminus(predicted, x).head<9>() - covariance * system.gradient;
    const Vec9 step = left.partialPivLu().solve(right);
    if (!step.allFinite()) break;
    x = boxplus(x, widened(step));
    converged = widening == 0 && step.head<3>().norm() < kConvergedM &&
                step.segment<3>(lio::kRotation).norm() < kConvergedRad;
    widening = widening < kLeastWidening ? 0 : kNarrowing * widening;
  }
  return result;
}

}  // namespace paloc
