#include "paloc/core/robust_kernel.h"

#include <gtest/gtest.h>

namespace paloc {
namespace {

class RobustKernelOf : public testing::TestWithParam<RobustKernel::Kind> {};

TEST_P(RobustKernelOf, WeightIsTheDerivativeOfTheCost) {
  for (const double width : {0.5, 1.345, 10.0}) {
    const RobustKernel kernel{GetParam(), width};
    for (const double s : {0.01, 0.2, 1.0, 3.0, 30.0, 1e4}) {
      const double step = 1e-6 * s;
      const double slope = (kernel.cost(s + step) - kernel.cost(s - step)) / (2 * step);
      EXPECT_NEAR(std::pow(kernel.sqrtWeight(s), 2), slope, 1e-6)
          << "width " << width << " s " << s;
    }
    EXPECT_DOUBLE_EQ(kernel.cost(0), 0);
    EXPECT_DOUBLE_EQ(kernel.sqrtWeight(0), 1);
  }
}

INSTANTIATE_TEST_SUITE_P(AllKinds, RobustKernelOf,
                         testing::Values(RobustKernel::Kind::kNone, RobustKernel::Kind::kHuber,
                                         RobustKernel::Kind::kCauchy));

TEST(RobustKernel, ByHand) {
  const RobustKernel huber{RobustKernel::Kind::kHuber, 2};
  EXPECT_DOUBLE_EQ(huber.cost(4), 4);               // at the width: still quadratic
  EXPECT_DOUBLE_EQ(huber.cost(16), 2 * 2 * 4 - 4);  // beyond: linear in the residual
  EXPECT_DOUBLE_EQ(huber.sqrtWeight(16), std::sqrt(0.5));
  const RobustKernel cauchy{RobustKernel::Kind::kCauchy, 2};
  EXPECT_DOUBLE_EQ(cauchy.cost(4), 4 * std::log(2.0));
  EXPECT_DOUBLE_EQ(cauchy.sqrtWeight(12), 0.5);
}

}  // namespace
}  // namespace paloc
