#include "paloc/map/degeneracy.h"

#include <tbb/parallel_invoke.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "paloc/core/direction_information.h"
#include "paloc/core/shared_errors.h"

namespace paloc {
namespace {

constexpr double kConstrainingCosine = 0.1;  // well above the noise of any normal
// What is known of a direction must be twice what noise alone would give: its sigma is then told
// too small by a fifth at most.
constexpr double kSignalToNoise = 2;
constexpr double kFullShare = 0.005;
constexpr double kFull = 0.95, kNone = 0.05;

// How the other kind follows a motion of this one: other = follow * own. What noise alone would
// give is added to the block that is inverted: else a direction that nothing fixes, the axis of a
// corridor, would follow any rotation by metres.
Mat3 followingMotion(std::span<const PlaneRow> rows, const Mat6& information, DirectionKind own,
                     double normal_noise_rad) {
  const int at = static_cast<int>(own), other = 3 - at;
  double noise_information = 0;
  const double floor_var = normal_noise_rad * normal_noise_rad;
  for (const PlaneRow& row : rows) {
    const double normal_var = floor_var + row.normal_sigma * row.normal_sigma;
    const double lever_sq = own == DirectionKind::kRotation ? 1 : row.point_body.squaredNorm();
    noise_information += kSignalToNoise * normal_var * lever_sq / row.variance;
  }
  const Mat3 block = information.block<3, 3>(other, other) + noise_information * Mat3::Identity();
  return -pseudoInverse(block) * information.block<3, 3>(other, at);
}

struct Support {
  double count = 0;  // of constraining points
  double signal = 0, noise_mean = 0, variance = 0;
  double unweighted = 0;  // the signal without robust weights
};

/// A small motion: translation v and rotation w in the body frame.
struct Motion {
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();
};

// Of three motions in one pass: the rows do not fit in the first cache.
std::array<Support, 3> measureSupport(std::span<const PlaneRow> rows,
                                      const std::array<Motion, 3>& motions,
                                      double normal_noise_rad) {
  std::array<Support, 3> supports;
  const double floor_var = normal_noise_rad * normal_noise_rad;
  for (const PlaneRow& row : rows) {
    const double normal_var = floor_var + row.normal_sigma * row.normal_sigma;
    const double weight = 1 / row.variance;
    const double weight_before = weight / row.robust_weight;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Motion& m = motions[i];
      Support& support = supports[i];
      const Vec3 motion = m.v + m.w.cross(row.point_body);
      const double along = row.normal_body.dot(motion);
      const double along_sq = along * along, motion_sq = motion.squaredNorm();
      const double noise_var = normal_var * std::max(motion_sq - along_sq, 0.0) +
                               row.range_variance * m.w.cross(row.normal_body).squaredNorm();
      support.signal += weight * along_sq;
      support.unweighted += weight_before * along_sq;
      support.noise_mean += weight * noise_var;
      // Of the square of a normal variable with mean `along`.
      support.variance += weight * weight * noise_var * (2 * noise_var + 4 * along_sq);
      // Added as a number: which rows constrain cannot be foreseen by a branch.
      support.count += along_sq > kConstrainingCosine * kConstrainingCosine * motion_sq ? 1.0 : 0.0;
    }
  }
  return supports;
}

double informativeProbability(const Support& support) {
  if (support.signal <= 0) return 0;
  const double excess = support.signal - (1 + kSignalToNoise) * support.noise_mean;
  const double sigma = std::sqrt(support.variance);
  if (sigma <= 0) return excess > 0 ? 1 : 0;
  return 0.5 * std::erfc(-excess / (sigma * std::numbers::sqrt2));
}

DirectionClass classOf(double factor) {
  if (factor > kFull) return DirectionClass::kFull;
  return factor < kNone ? DirectionClass::kNone : DirectionClass::kPartial;
}

double factorOf(const MatchDirection& direction) {
  const double supporting = direction.share * direction.agreement * direction.agreement;
  const double factor = direction.probability * std::min(1.0, supporting / kFullShare);
  if (factor > kFull) return 1;
  return factor < kNone ? 0 : factor;
}

// The three directions of one kind, weakest first, with shares and probabilities. They are those of
// the rows alone: shared errors blur them, since a bias of the range turns the weakest axis towards
// whatever the bias moves most.
void observeKind(std::span<const PlaneRow> rows, const Mat6& geometry, double normal_noise_rad,
                 DirectionKind own, std::array<MatchDirection, 6>& directions) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(schurComplement(geometry, own));
  const Mat3 follow = followingMotion(rows, geometry, own, normal_noise_rad);
  std::array<double, 3> counts{};
  std::array<Motion, 3> motions;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = solver.eigenvectors().col(i);
    const Vec3 other = follow * axis;
    motions[static_cast<std::size_t>(i)] =
        own == DirectionKind::kPosition ? Motion{axis, other} : Motion{other, axis};
  }
  const std::array<Support, 3> supports = measureSupport(rows, motions, normal_noise_rad);
  for (int i = 0; i < 3; ++i) {
    const Support& support = supports[static_cast<std::size_t>(i)];
    MatchDirection& direction =
        directions[static_cast<std::size_t>(own) + static_cast<std::size_t>(i)];
    direction.axis_body = solver.eigenvectors().col(i);
    direction.probability = informativeProbability(support);
    direction.agreement = support.unweighted > 0 ? support.signal / support.unweighted : 0;
    counts[static_cast<std::size_t>(i)] = support.count;
  }
  const double largest = std::max({counts[0], counts[1], counts[2], 1.0});
  for (std::size_t i = 0; i < 3; ++i) {
    MatchDirection& direction = directions[static_cast<std::size_t>(own) + i];
    direction.share = counts[i] / largest;
    direction.cls = classOf(factorOf(direction));
  }
}

// The sigmas of the directions of one kind, of what is left under shared errors.
void measureSigmas(const Mat6& information, DirectionKind own,
                   std::array<MatchDirection, 6>& directions) {
  const Mat3 schur = schurComplement(information, own);
  for (std::size_t i = 0; i < 3; ++i) {
    MatchDirection& direction = directions[static_cast<std::size_t>(own) + i];
    const double along = std::max(direction.axis_body.dot(schur * direction.axis_body), 0.0);
    direction.sigma =
        1 / std::sqrt(std::max(factorOf(direction) * along, 1 / (kUnknownSigma * kUnknownSigma)));
  }
}

void attenuateKind(DirectionKind own, const std::array<MatchDirection, 6>& directions,
                   Mat6& information) {
  for (std::size_t i = 0; i < 3; ++i) {
    const MatchDirection& direction = directions[static_cast<std::size_t>(own) + i];
    const double factor = factorOf(direction);
    if (factor < 1) scaleDirection(information, own, direction.axis_body, factor);
  }
}

}  // namespace

DirectionObserver::DirectionObserver(std::span<const PlaneRow> rows, double normal_noise_rad)
    : geometry_(leastSquares(rows).information) {
  const auto observe = [&](DirectionKind own) {
    observeKind(rows, geometry_, normal_noise_rad, own, directions_);
  };
  tbb::parallel_invoke([&] { observe(DirectionKind::kPosition); },
                       [&] { observe(DirectionKind::kRotation); });
}

ObservedDirections DirectionObserver::under(const Mat6& spread) const {
  ObservedDirections observed{directions_, geometry_, spread};
  const Mat6 whole = informationUnderSharedErrors(geometry_, spread);
  for (const DirectionKind own : {DirectionKind::kPosition, DirectionKind::kRotation}) {
    measureSigmas(whole, own, observed.directions);
    attenuateKind(own, observed.directions, observed.information);
  }
  cutToKnown(observed.information, observed.shared_spread);
  observed.information = (0.5 * (observed.information + observed.information.transpose())).eval();
  return observed;
}

ObservedDirections observeDirections(std::span<const PlaneRow> rows, const Mat6& spread,
                                     double normal_noise_rad) {
  return DirectionObserver(rows, normal_noise_rad).under(spread);
}

}  // namespace paloc
