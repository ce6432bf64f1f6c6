#include "paloc/core/imu_buffer.h"

#include <gtest/gtest.h>

#include <limits>

#include "paloc/core/imu_factor.h"
#include "smooth_motion.h"

namespace paloc {
namespace {

constexpr double kMaxGap_s = 0.02;

ImuBuffer filled(const test::SmoothMotion& motion, double from, double to, double step = 0.005) {
  ImuBuffer buffer;
  const int count = static_cast<int>(std::lround((to - from) / step));
  for (int k = 0; k <= count; ++k) buffer.add(motion.imu(from + k * step));
  return buffer;
}

std::optional<Preintegration> integrate(const ImuBuffer& buffer, double from, double to) {
  return buffer.integrate(nsFromSeconds(from), nsFromSeconds(to), kMaxGap_s, ImuNoise(),
                          Vec3::Zero(), Vec3::Zero());
}

TEST(ImuBuffer, PredictsTheMotionBetweenAnyTwoInstants) {
  const test::SmoothMotion motion;
  const ImuBuffer buffer = filled(motion, 0, 2);
  for (const double from : {0.0, 0.1003, 0.7}) {
    for (const double dt : {0.0021, 0.1, 0.5}) {
      const auto p = integrate(buffer, from, from + dt);
      ASSERT_TRUE(p.has_value());
      EXPECT_NEAR(p->dt_s, dt, 1e-9);
      const State end = ImuFactor(*p, motion.gravity_mps2).predict(motion.state(from));
      const StateVector error = boxminus(end, motion.state(from + dt));
      EXPECT_LT(error.segment<3>(tangent::kPosition).norm(), 2e-4 * dt) << from << ' ' << dt;
      EXPECT_LT(error.segment<3>(tangent::kRotation).norm(), 2e-5) << from << ' ' << dt;
      EXPECT_LT(error.segment<3>(tangent::kVelocity).norm(), 5e-4) << from << ' ' << dt;
    }
  }
}

TEST(ImuBuffer, RefusesWhatIsNotCovered) {
  const test::SmoothMotion motion;
  ImuBuffer buffer = filled(motion, 1, 2);
  EXPECT_FALSE(integrate(buffer, 0.9, 1.1)) << "starts before the samples";
  EXPECT_FALSE(integrate(buffer, 1.9, 2.1)) << "ends after them";
  EXPECT_TRUE(integrate(buffer, 0.99, 1.1)) << "a hold shorter than the gap";
  EXPECT_FALSE(integrate(buffer, 1.5, 1.5));
  EXPECT_FALSE(integrate(buffer, 1.6, 1.5));
  buffer.add(motion.imu(2.5));
  EXPECT_FALSE(integrate(buffer, 1.9, 2.5)) << "a hole in the middle";
  EXPECT_FALSE(integrate(ImuBuffer(), 0, 1));
}

TEST(ImuBuffer, TakesOnlyFiniteSamplesInOrder) {
  const test::SmoothMotion motion;
  ImuBuffer buffer;
  EXPECT_TRUE(buffer.add(motion.imu(1)));
  EXPECT_FALSE(buffer.add(motion.imu(1)));
  EXPECT_FALSE(buffer.add(motion.imu(0.5)));
  ImuSample bad = motion.imu(2);
  bad.acc_body.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(buffer.add(bad));
  EXPECT_EQ(buffer.size(), 1u);
}

TEST(ImuBuffer, ForgettingKeepsWhatIsStillNeeded) {
  const test::SmoothMotion motion;
  ImuBuffer buffer = filled(motion, 0, 2);
  const auto before = integrate(buffer, 1.0012, 1.5);
  buffer.forgetBefore(nsFromSeconds(1.0012));
  const auto after = integrate(buffer, 1.0012, 1.5);
  ASSERT_TRUE(before && after);
  EXPECT_LT(buffer.size(), 210u);
  EXPECT_EQ(before->delta_p, after->delta_p);
}

}  // namespace
}  // namespace paloc
