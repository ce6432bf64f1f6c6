#include "paloc/map/degeneracy.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion_support.h"
#include "paloc/core/direction_information.h"
#include "paloc/core/shared_errors.h"

namespace paloc {
namespace {

// What is known of a direction must be twice what noise alone would give: its sigma is then told
// too small by a fifth at most.
constexpr double kSignalToNoise = 2;
constexpr double kFullShare = 0.005;
// Rows, all telling as much, that may be wrong together, and those that may, but seldom are.
constexpr double kFewRows = 50, kSomeRows = 120;
constexpr double kFull = 0.95, kNone = 0.05;

// How the other kind follows a motion of this one: other = follow * own. What noise alone would
// give is added to the block that is inverted: else a direction that nothing fixes, the axis of a
// corridor, would follow any rotation by metres.
Mat3 followingMotion(const SupportRows& rows, const Mat6& information, DirectionKind own) {
  const int at = static_cast<int>(own), other = 3 - at;
  const double noise = kSignalToNoise * (own == DirectionKind::kRotation ? rows.noiseOfTranslation()
                                                                         : rows.noiseOfRotation());
  const Mat3 block = information.block<3, 3>(other, other) + noise * Mat3::Identity();
  return -pseudoInverse(block) * information.block<3, 3>(other, at);
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

bool hangsOnFew(const Support& support, const Motion& motion, const MotionCheck& worse) {
  const double rows = support.effectiveRows();
  return rows < kSomeRows && worse(motion) < (rows < kFewRows ? 1 : 0);
}

// The three directions of one kind, weakest first, with shares and probabilities. They are those of
// the rows alone: shared errors blur them, since a bias of the range turns the weakest axis towards
// whatever the bias moves most.
void observeKind(const SupportRows& rows, const Mat6& geometry, DirectionKind own,
                 const MotionCheck& worse, std::array<MatchDirection, 6>& directions) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(schurComplement(geometry, own));
  const Mat3 follow = followingMotion(rows, geometry, own);
  std::array<double, 3> counts{};
  std::array<Motion, 3> motions;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = solver.eigenvectors().col(i);
    const Vec3 other = follow * axis;
    motions[static_cast<std::size_t>(i)] =
        own == DirectionKind::kPosition ? Motion{axis, other} : Motion{other, axis};
  }
  const std::array<Support, 3> supports = rows.of(motions);
  for (int i = 0; i < 3; ++i) {
    const Support& support = supports[static_cast<std::size_t>(i)];
    MatchDirection& direction =
        directions[static_cast<std::size_t>(own) + static_cast<std::size_t>(i)];
    direction.axis_body = solver.eigenvectors().col(i);
    direction.probability = informativeProbability(support);
    direction.agreement = support.unweighted > 0 ? support.signal / support.unweighted : 0;
    counts[static_cast<std::size_t>(i)] = support.count;
    if (worse && direction.probability > kNone &&
        hangsOnFew(support, motions[static_cast<std::size_t>(i)], worse)) {
      direction.probability = 0;
    }
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

DirectionObserver::DirectionObserver(std::span<const PlaneRow> rows, double normal_noise_rad,
                                     const MotionCheck& worse)
    : geometry_(leastSquares(rows).information) {
  const SupportRows support(rows, normal_noise_rad);
  for (const DirectionKind own : {DirectionKind::kPosition, DirectionKind::kRotation}) {
    observeKind(support, geometry_, own, worse, directions_);
  }
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
