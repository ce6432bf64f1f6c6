#include "paloc/core/direction_information.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "random_states.h"

namespace paloc {
namespace {

using Square = Eigen::Matrix<double, 6, 6>;

Mat6 randomInformation(RandomStates& random) {
  Square root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = random.normal();
  return root * root.transpose() + 0.1 * Square::Identity();
}

TEST(DirectionInformation, TheSchurComplementIsTheInverseOfTheMarginalCovariance) {
  RandomStates random(7);
  for (int k = 0; k < 100; ++k) {
    const Mat6 information = randomInformation(random);
    const Square covariance = Square(information).inverse();
    const Mat3 position = covariance.topLeftCorner<3, 3>().inverse();
    const Mat3 rotation = covariance.bottomRightCorner<3, 3>().inverse();
    EXPECT_LT((schurComplement(information, DirectionKind::kPosition) - position).norm(),
              1e-8 * position.norm());
    EXPECT_LT((schurComplement(information, DirectionKind::kRotation) - rotation).norm(),
              1e-8 * rotation.norm());
  }
}

TEST(DirectionInformation, ScalesWhatIsKnownAlongOneDirectionOnly) {
  RandomStates random(8);
  for (int k = 0; k < 100; ++k) {
    const auto kind = k % 2 == 0 ? DirectionKind::kPosition : DirectionKind::kRotation;
    const Mat6 before = randomInformation(random);
    const Vec3 axis = random.direction();
    const double factor = random.uniform(0, 1);
    Mat6 after = before;
    scaleDirection(after, kind, axis, factor);
    const Mat3 schur = schurComplement(before, kind), scaled = schurComplement(after, kind);
    EXPECT_NEAR(axis.dot(scaled * axis), factor * axis.dot(schur * axis), 1e-9 * schur.norm());
    // Motions that the direction's information does not see keep theirs.
    const Vec3 unseen = (schur * axis).unitOrthogonal();
    EXPECT_NEAR(unseen.dot(scaled * unseen), unseen.dot(schur * unseen), 1e-9 * schur.norm());
  }
}

TEST(DirectionInformation, CutsTheSpreadToWhatIsKnown) {
  RandomStates random(9);
  Mat6 information = randomInformation(random), spread = randomInformation(random);
  const Mat6 spread_before = spread;
  cutToKnown(information, spread);
  EXPECT_EQ((spread - spread_before).norm(), 0) << "all is known";

  const Vec3 axis = random.direction();
  scaleDirection(information, DirectionKind::kPosition, axis, 0);
  cutToKnown(information, spread);
  const Eigen::SelfAdjointEigenSolver<Square> solver(information);
  EXPECT_GE(solver.eigenvalues()[0], -1e-12 * solver.eigenvalues()[5]);
  EXPECT_GT(solver.eigenvalues()[1], 1e-6 * solver.eigenvalues()[5]) << "one direction only";
  const Vec6 unknown = solver.eigenvectors().col(0);
  EXPECT_LT((spread * unknown).norm(), 1e-9 * spread.norm());
}

}  // namespace
}  // namespace paloc
