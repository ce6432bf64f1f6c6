#include "paloc/core/prior_factor.h"

#include <gtest/gtest.h>

#include <limits>

#include "random_states.h"

namespace paloc {
namespace {

double costAt(const PriorFactor& prior, const State& x) {
  StateMatrix hessian = StateMatrix::Zero();
  StateVector b = StateVector::Zero();
  return prior.addTo(x, hessian, b);
}

StateMatrix randomInformation(RandomStates& random) {
  StateMatrix a;
  for (int k = 0; k < a.size(); ++k) a.data()[k] = random.normal(3);
  return a * a.transpose();
}

StateVector randomVector(RandomStates& random) {
  StateVector v;
  for (int k = 0; k < v.size(); ++k) v[k] = random.normal(3);
  return v;
}

TEST(PriorFactor, GradientAndHessianAreThoseOfItsCost) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const State mean = random.state();
    const State x = random.relatedTo(mean, trial);
    const PriorFactor prior(mean, randomInformation(random), randomVector(random));
    StateMatrix hessian = StateMatrix::Zero();
    StateVector b = StateVector::Zero();
    prior.addTo(x, hessian, b);
    constexpr double kStep = 1e-4;
    StateVector gradient;
    StateMatrix jacobian;  // of d = x boxminus mean
    for (int k = 0; k < tangent::kDim; ++k) {
      const State ahead = boxplus(x, kStep * StateVector::Unit(k));
      const State behind = boxplus(x, -kStep * StateVector::Unit(k));
      gradient[k] = (costAt(prior, ahead) - costAt(prior, behind)) / (2 * kStep);
      jacobian.col(k) = (boxminus(ahead, mean) - boxminus(behind, mean)) / (2 * kStep);
    }
    const double scale = 1 + b.norm() + prior.information().norm();
    ASSERT_LT((b + 0.5 * gradient).norm(), 1e-6 * scale) << trial;
    const StateMatrix expected = jacobian.transpose() * prior.information() * jacobian;
    ASSERT_LT((hessian - expected).norm(), 1e-6 * scale) << trial;
  }
}

TEST(PriorFactor, FromSigmasByHand) {
  StateVector sigma = StateVector::Constant(std::numeric_limits<double>::infinity());
  sigma[tangent::kVelocity] = 0.5;
  sigma[tangent::kRotation + 2] = 0.01;
  const PriorFactor prior = PriorFactor::fromSigmas(State(), sigma);
  State x;
  x.T_map_body = {Vec3(100, 0, 0), so3::exp(Vec3(0, 0, 0.03))};
  x.v_map = Vec3(1, 7, 0);
  EXPECT_NEAR(costAt(prior, x), 4 + 9, 1e-9);
  StateMatrix hessian = StateMatrix::Zero();
  StateVector b = StateVector::Zero();
  prior.addTo(State(), hessian, b);
  StateVector expected = StateVector::Zero();
  expected[tangent::kVelocity] = 4;
  expected[tangent::kRotation + 2] = 1e4;
  EXPECT_LT((hessian - StateMatrix(expected.asDiagonal())).norm(), 1e-9);
  EXPECT_TRUE(b.isZero(0));
}

}  // namespace
}  // namespace paloc
