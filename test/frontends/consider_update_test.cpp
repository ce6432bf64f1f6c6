#include "paloc/frontends/consider_update.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <random>

namespace paloc {
namespace {

constexpr int kDim = 6, kConsidered = 2;
using Update = ConsiderUpdate<kDim>;
using Matrix = Update::Matrix;
using Vector = Update::Vector;

/// A prior whose errors along the considered directions are large, and go with all others; and a
/// measurement that does not see them.
class ConsiderUpdateTest : public ::testing::Test {
 protected:
  ConsiderUpdateTest() {
    const Matrix any = random();
    const Eigen::HouseholderQR<Matrix> qr(any);
    const Matrix basis = qr.householderQ();
    across_ = basis.rightCols<kDim - kConsidered>();
    Eigen::Matrix2d mix;
    mix << 2, 1, 0, 1;
    considered_ = basis.leftCols<kConsidered>() * mix;
    const Matrix root = random() + 5 * considered_ * random().topRows<kConsidered>();
    covariance_ = root * root.transpose();
    H_ = 3 * random() * across_ * across_.transpose();
    update_.begin(covariance_, considered_);
    update_.measure(H_.transpose() * H_);
  }

  Matrix random() {
    Matrix m;
    for (double& value : m.reshaped()) value = normal_(rng_);
    return m;
  }

  std::mt19937_64 rng_{5};
  std::normal_distribution<double> normal_;
  Update update_;
  Update::Directions considered_;
  Eigen::Matrix<double, kDim, kDim - kConsidered> across_;
  Matrix covariance_, H_;  // H whitened: the noise has unit covariance
};

TEST_F(ConsiderUpdateTest, IsTheKalmanUpdateWhereNothingIsConsidered) {
  Update update;
  update.begin(covariance_, Update::Directions(kDim, 0));
  update.measure(H_.transpose() * H_);
  const Matrix posterior = (covariance_.inverse() + H_.transpose() * H_).inverse();
  EXPECT_LT((update.covariance() - posterior).norm(), 1e-9 * covariance_.norm());
  const Vector gradient = random().col(0);
  EXPECT_LT((update.step(Vector::Zero(), gradient) + posterior * gradient).norm(), 1e-8);
  EXPECT_LT((update.gained() - (covariance_ - posterior)).norm(), 1e-9 * covariance_.norm());
}

TEST_F(ConsiderUpdateTest, WhatIsConsideredStays) {
  const Vector step = update_.step(Vector::Zero(), random().col(0));
  EXPECT_GT(step.norm(), 0.01);
  const Eigen::VectorXd along = considered_.transpose() * step;
  EXPECT_LT(along.norm(), 1e-9);
  const Eigen::Matrix2d before = considered_.transpose() * covariance_ * considered_;
  const Eigen::Matrix2d after = considered_.transpose() * update_.covariance() * considered_;
  EXPECT_LT((after - before).norm(), 1e-9 * before.norm());
}

// Across what is considered may be what some functional does not see: that stays as it is, and
// with it whatever goes with the rest.
TEST_F(ConsiderUpdateTest, WhatAFunctionalTellsStays) {
  const Matrix any = random();
  const Eigen::MatrixXd tilted =
      (considered_ + 0.5 * across_ * any.topLeftCorner(4, 2)).transpose();
  const Eigen::MatrixXd along = (tilted * considered_).inverse() * tilted;
  Update update;
  update.begin(covariance_, considered_, along);
  update.measure(H_.transpose() * H_);
  const Vector step = update.step(Vector::Zero(), H_.transpose() * random().col(0));
  EXPECT_GT(step.norm(), 0.01);
  EXPECT_LT((along * step).norm(), 1e-9 * step.norm() + 1e-9);
  const Eigen::MatrixXd before = along * covariance_ * along.transpose();
  const Eigen::MatrixXd after = along * update.covariance() * along.transpose();
  EXPECT_LT((after - before).norm(), 1e-8 * before.norm());
}

// However much the rest goes with what is considered: the measurement tells it whole.
TEST_F(ConsiderUpdateTest, TheRestIsKnownAsWellAsIfItWereAll) {
  using Rest = Eigen::Matrix<double, kDim - kConsidered, kDim - kConsidered>;
  const Rest prior = across_.transpose() * covariance_ * across_;
  const Rest information = across_.transpose() * H_.transpose() * H_ * across_;
  const Rest expected = (prior.inverse() + information).inverse();
  const Rest updated = across_.transpose() * update_.covariance() * across_;
  EXPECT_LT((updated - expected).norm(), 1e-9 * prior.norm());
  EXPECT_LT(updated.trace(), 0.01 * prior.trace());
}

TEST_F(ConsiderUpdateTest, TheErrorsAreAsTheCovariancesSay) {
  const Matrix root = covariance_.llt().matrixL();
  Matrix errors = Matrix::Zero(), crosses = Matrix::Zero(), steps = Matrix::Zero();
  constexpr int kDraws = 40'000;
  for (int i = 0; i < kDraws; ++i) {
    const Vector error = root * random().col(0), noise = random().col(0);
    const Vector gradient = H_.transpose() * (H_ * error - noise);
    const Vector step = update_.step(Vector::Zero(), gradient), left = error + step;
    errors += left * left.transpose() / kDraws;
    crosses += left * error.transpose() / kDraws;
    steps += step * step.transpose() / kDraws;
  }
  const Matrix covariance = update_.covariance();
  const Eigen::LLT<Eigen::MatrixXd> expected(covariance);
  ASSERT_EQ(expected.info(), Eigen::Success);
  const Eigen::MatrixXd half = expected.matrixL().solve(errors);
  const Eigen::MatrixXd whitened = expected.matrixL().solve(half.transpose());
  EXPECT_LT((whitened - Matrix::Identity()).cwiseAbs().maxCoeff(), 0.04);
  EXPECT_LT((crosses - update_.updated(covariance_)).norm(), 0.02 * covariance_.norm());
  EXPECT_LT((steps - update_.gained()).norm(), 0.04 * update_.gained().norm());
}

// From a state that is off the prior's mean, the step leads to the same posterior.
TEST_F(ConsiderUpdateTest, AStepFromElsewhereLeadsToTheSameState) {
  const Vector gradient = random().col(0);
  const Vector straight = update_.step(Vector::Zero(), gradient);
  const Vector off = across_ * Eigen::Vector4d(0.3, -0.2, 0.1, 0.5);
  const Vector there = gradient + H_.transpose() * H_ * off;
  EXPECT_LT((off + update_.step(off, there) - straight).norm(), 1e-9);
}

}  // namespace
}  // namespace paloc
