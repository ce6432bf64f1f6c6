#include "paloc/map/degeneracy.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

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
// What the others tell is enough, in what makes a direction informative: well above, since the rest
// of an object at whose edge the few lie is no better.
constexpr double kWithoutFew = 8;
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

// What observes the directions.
struct Observed {
  std::span<const PlaneRow> rows;
  const SupportRows& support;
  const Mat6& geometry;
  const MotionCheck& worse;
};

Motion motionAlong(const Vec3& axis, const Mat3& follow, DirectionKind own) {
  const Vec3 other = follow * axis;
  return own == DirectionKind::kPosition ? Motion{axis, other} : Motion{other, axis};
}

// What is known but for the few rows that tell most of a motion.
Mat6 withoutTelling(const Observed& by, const Motion& motion) {
  std::vector<std::pair<double, std::size_t>> told(by.rows.size());
  for (std::size_t i = 0; i < by.rows.size(); ++i) {
    const PlaneRow& row = by.rows[i];
    const double along = row.normal_body.dot(motion.v + motion.w.cross(row.point_body));
    told[i] = {-along * along / row.variance, i};
  }
  const std::size_t few = std::min(told.size(), static_cast<std::size_t>(kFewRows));
  const auto end = told.begin() + static_cast<std::ptrdiff_t>(few);
  std::nth_element(told.begin(), end, told.end());
  std::sort(told.begin(), end);  // an order that does not hang on the library's
  Mat6 rest = by.geometry;
  for (std::size_t k = 0; k < few; ++k) {
    rest -= leastSquares(by.rows.subspan(told[k].second, 1)).information;
  }
  return rest;
}

// Rows that are wrong together would make the rotation follow to where they are less so: the
// question is put for the motion that the others would allow; and not where these tell enough.
bool hangsOnFew(const Observed& by, const Support& support, const Motion& translation) {
  const double rows = support.effectiveRows();
  if (!by.worse || rows >= kSomeRows) return false;
  const Mat6 rest = withoutTelling(by, translation);
  const Vec3& v = translation.v;
  const double told = v.dot(schurComplement(rest, DirectionKind::kPosition) * v);
  if (told > kWithoutFew * (1 + kSignalToNoise) * support.noise_mean) return false;
  const Mat3 follow = followingMotion(by.support, rest, DirectionKind::kPosition);
  return by.worse({v, follow * v}) < (rows < kFewRows ? 1 : 0);
}

// The three directions of one kind, weakest first, with shares and probabilities. They are those of
// the rows alone: shared errors blur them, since a bias of the range turns the weakest axis towards
// whatever the bias moves most.
void observeKind(const Observed& by, DirectionKind own, std::array<MatchDirection, 6>& directions) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(schurComplement(by.geometry, own));
  const Mat3 follow = followingMotion(by.support, by.geometry, own);
  std::array<Motion, 3> motions;
  for (int i = 0; i < 3; ++i) {
    motions[static_cast<std::size_t>(i)] = motionAlong(solver.eigenvectors().col(i), follow, own);
  }
  const std::array<Support, 3> supports = by.support.of(motions);
  const double largest = std::max({supports[0].count, supports[1].count, supports[2].count, 1.0});
  for (std::size_t i = 0; i < 3; ++i) {
    const Support& support = supports[i];
    MatchDirection& direction = directions[static_cast<std::size_t>(own) + i];
    direction.axis_body = solver.eigenvectors().col(static_cast<Eigen::Index>(i));
    direction.probability = informativeProbability(support);
    direction.agreement = support.unweighted > 0 ? support.signal / support.unweighted : 0;
    direction.share = support.count / largest;
    if (own == DirectionKind::kPosition && factorOf(direction) > 0 &&
        hangsOnFew(by, support, motions[i])) {
      direction.probability = 0;
    }
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
    observeKind({rows, support, geometry_, worse}, own, directions_);
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
