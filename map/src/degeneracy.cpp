#include "paloc/map/degeneracy.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "paloc/core/shared_errors.h"

namespace paloc {
namespace {

constexpr double kConstrainingCosine = 0.1;  // well above the noise of any normal
// What is known of a direction must be twice what noise alone would give: its sigma is then told
// too small by a fifth at most.
constexpr double kSignalToNoise = 2;
constexpr double kFullShare = 0.005;
constexpr double kFull = 0.95, kNone = 0.05;
constexpr double kUnknownInformation = 1e-12;  // keeps the sigma of a free direction finite

constexpr int kTranslation = 0, kRotation = 3;  // offsets in the tangent

// The inverse of a symmetric positive semidefinite block on the space where it is not zero.
Mat3 pseudoInverse(const Mat3& block) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(block);
  const double smallest = 1e-12 * std::max(solver.eigenvalues()[2], 1e-300);
  Vec3 inverse = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (solver.eigenvalues()[i] > smallest) inverse[i] = 1 / solver.eigenvalues()[i];
  }
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

// The three by three block of one kind with the other kind eliminated.
Mat3 schurComplement(const Mat6& information, int own) {
  const int other = kRotation - own;
  const Mat3 cross = information.block<3, 3>(other, own);
  const Mat3 schur =
      information.block<3, 3>(own, own) -
      cross.transpose() * pseudoInverse(information.block<3, 3>(other, other)) * cross;
  return 0.5 * (schur + schur.transpose());
}

// How the other kind follows a motion of this one: other = follow * own. What noise alone would
// give is added to the block that is inverted: else a direction that nothing fixes, the axis of a
// corridor, would follow any rotation by metres.
Mat3 followingMotion(std::span<const PlaneRow> rows, const Mat6& information, int own,
                     double normal_noise_rad) {
  const int other = kRotation - own;
  double noise_information = 0;
  const double floor_var = normal_noise_rad * normal_noise_rad;
  for (const PlaneRow& row : rows) {
    const double normal_var = floor_var + row.normal_sigma * row.normal_sigma;
    const double lever_sq = other == kTranslation ? 1 : row.point_body.squaredNorm();
    noise_information += kSignalToNoise * normal_var * lever_sq / row.variance;
  }
  const Mat3 block = information.block<3, 3>(other, other) + noise_information * Mat3::Identity();
  return -pseudoInverse(block) * information.block<3, 3>(other, own);
}

struct Support {
  double count = 0;  // of constraining points
  double signal = 0, noise_mean = 0, variance = 0;
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
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Motion& m = motions[i];
      Support& support = supports[i];
      const Vec3 motion = m.v + m.w.cross(row.point_body);
      const double along = row.normal_body.dot(motion);
      const double along_sq = along * along, motion_sq = motion.squaredNorm();
      const double noise_var = normal_var * std::max(motion_sq - along_sq, 0.0) +
                               row.range_variance * m.w.cross(row.normal_body).squaredNorm();
      support.signal += weight * along_sq;
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
  const double factor = direction.probability * std::min(1.0, direction.share / kFullShare);
  if (factor > kFull) return 1;
  return factor < kNone ? 0 : factor;
}

// The three directions of one kind, weakest first, with shares, probabilities and sigmas. They are
// those of the rows alone: shared errors blur them, since a bias of the range turns the weakest
// axis towards whatever the bias moves most.
void observeKind(std::span<const PlaneRow> rows, const Mat6& geometry, const Mat6& information,
                 double normal_noise_rad, int own, std::array<MatchDirection, 6>& directions) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(schurComplement(geometry, own));
  const Mat3 follow = followingMotion(rows, geometry, own, normal_noise_rad);
  const Mat3 schur = schurComplement(information, own);
  std::array<double, 3> counts{}, along{};
  std::array<Motion, 3> motions;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = solver.eigenvectors().col(i);
    const Vec3 other = follow * axis;
    motions[static_cast<std::size_t>(i)] =
        own == kTranslation ? Motion{axis, other} : Motion{other, axis};
  }
  const std::array<Support, 3> supports = measureSupport(rows, motions, normal_noise_rad);
  for (int i = 0; i < 3; ++i) {
    const Support& support = supports[static_cast<std::size_t>(i)];
    MatchDirection& direction =
        directions[static_cast<std::size_t>(own) + static_cast<std::size_t>(i)];
    direction.axis_body = solver.eigenvectors().col(i);
    direction.probability = informativeProbability(support);
    along[static_cast<std::size_t>(i)] =
        std::max(direction.axis_body.dot(schur * direction.axis_body), 0.0);
    counts[static_cast<std::size_t>(i)] = support.count;
  }
  const double largest = std::max({counts[0], counts[1], counts[2], 1.0});
  for (std::size_t i = 0; i < 3; ++i) {
    MatchDirection& direction = directions[static_cast<std::size_t>(own) + i];
    direction.share = counts[i] / largest;
    const double factor = factorOf(direction);
    direction.cls = classOf(factor);
    direction.sigma = 1 / std::sqrt(std::max(factor * along[i], kUnknownInformation));
  }
}

void attenuateKind(int own, const std::array<MatchDirection, 6>& directions, Mat6& information) {
  for (int i = 0; i < 3; ++i) {
    const MatchDirection& direction =
        directions[static_cast<std::size_t>(own) + static_cast<std::size_t>(i)];
    const double factor = factorOf(direction);
    if (factor >= 1) continue;
    const Mat3 schur = schurComplement(information, own);
    const Vec3 x = schur * direction.axis_body;
    const double along = direction.axis_body.dot(x);
    if (along <= 0) continue;
    information.block<3, 3>(own, own) -= ((1 - factor) / along) * x * x.transpose();
  }
}

// Rounding may leave an eigenvalue a little below zero where information was taken away; and the
// spread must not reach into what is not known.
void cleanUp(ObservedDirections& observed) {
  using Square = Eigen::Matrix<double, 6, 6>;
  const Eigen::SelfAdjointEigenSolver<Square> solver(observed.information);
  const Vec6 eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  const Square& vectors = solver.eigenvectors();
  const double smallest = 1e-9 * eigenvalues[5];
  if (eigenvalues[0] > smallest) return;
  observed.information = vectors * eigenvalues.asDiagonal() * vectors.transpose();
  const Vec6 known = (eigenvalues.array() > smallest).cast<double>();
  const Square projector = vectors * known.asDiagonal() * vectors.transpose();
  observed.shared_spread = (projector * observed.shared_spread * projector).eval();
}

}  // namespace

ObservedDirections observeDirections(std::span<const PlaneRow> rows, const Mat6& spread,
                                     double normal_noise_rad) {
  ObservedDirections observed;
  observed.information = leastSquares(rows).information;
  observed.shared_spread = spread;
  const Mat6 geometry = observed.information;
  const Mat6 whole = informationUnderSharedErrors(geometry, spread);
  observeKind(rows, geometry, whole, normal_noise_rad, kTranslation, observed.directions);
  observeKind(rows, geometry, whole, normal_noise_rad, kRotation, observed.directions);
  attenuateKind(kTranslation, observed.directions, observed.information);
  attenuateKind(kRotation, observed.directions, observed.information);
  cleanUp(observed);
  observed.information = (0.5 * (observed.information + observed.information.transpose())).eval();
  return observed;
}

}  // namespace paloc
