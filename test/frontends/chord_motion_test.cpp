#include "paloc/frontends/chord_motion.h"

#include <gtest/gtest.h>

#include <random>

namespace paloc {
namespace {

class Random {
 public:
  Vec3 vector() { return {normal_(engine_), normal_(engine_), normal_(engine_)}; }
  ChordMotion motion() {
    return {{3 * vector(), so3::exp(2 * vector())},
            2 * vector(),
            1.5 * vector(),
            3 * vector(),
            2 * vector(),
            0.1};
  }

 private:
  std::mt19937_64 engine_{21};
  std::normal_distribution<double> normal_;
};

TEST(ChordMotion, MovedByTheDifferenceItIsTheOther) {
  Random random;
  for (int trial = 0; trial < 1000; ++trial) {
    const ChordMotion from = random.motion(), to = random.motion();
    const ChordMotion moved = boxplus(from, boxminus(to, from));
    EXPECT_LT(boxminus(moved, to).norm(), 1e-9);
  }
}

TEST(ChordMotion, EndsOfTheChordAreWhateverItsBend) {
  Random random;
  for (int trial = 0; trial < 100; ++trial) {
    const ChordMotion x = random.motion();
    const ChordMotion y = continued(x, 0.1);
    EXPECT_LT(boxminus(y.before(0.1), x.T_odom_body).norm(), 1e-9) << "whatever the bend";
    EXPECT_LT(boxminus(y.before(0), y.T_odom_body).norm(), 1e-12);
    // p(t) = p - v tau - a s, with s = tau (T - tau) / 2: its second derivative is a.
    const auto at = [&](double age_s) { return y.before(age_s).position; };
    const Vec3 second = (at(0.02) - 2 * at(0.03) + at(0.04)) / 1e-4;
    EXPECT_LT((second - y.acceleration_odom).norm(), 1e-8);
  }
}

TEST(ChordMotion, TransitionIsTheDerivative) {
  Random random;
  for (int trial = 0; trial < 1000; ++trial) {
    const ChordMotion x = random.motion();
    constexpr double kDt = 0.1, kStep = 1e-5;
    const ChordMotion y = continued(x, kDt);
    const ChordMatrix F = continuedTransition(x, kDt);
    for (int k = 0; k < chord::kDim; ++k) {
      const auto moved = [&](double step) {
        return boxminus(continued(boxplus(x, step * ChordVector::Unit(k)), kDt), y);
      };
      const ChordVector numeric = (moved(kStep) - moved(-kStep)) / (2 * kStep);
      EXPECT_LT((F.col(k) - numeric).cwiseAbs().maxCoeff(), 1e-7) << "column " << k;
    }
  }
}

}  // namespace
}  // namespace paloc
