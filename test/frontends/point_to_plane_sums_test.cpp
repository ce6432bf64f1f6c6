#include "paloc/frontends/point_to_plane_sums.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <vector>

namespace paloc {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double normal() { return normal_(engine_); }
  double uniform(double from, double to) { return from + (to - from) * uniform_(engine_); }
  Vec3 vector() { return {normal(), normal(), normal()}; }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
};

using Vec18 = Eigen::Matrix<double, 18, 1>;

TEST(PointToPlaneSums, JacobianIsTheDerivative) {
  Random random(7);
  for (int trial = 0; trial < 1000; ++trial) {
    const Vec3 p = random.vector(), v = random.vector(), acc = random.vector(), c = random.vector();
    const Vec3 lever = 5 * random.vector();  // R_tau q
    const Vec3 n = random.vector().normalized();
    const double tau = random.uniform(0, 0.1), sag = random.uniform(0, 0.1);
    const auto residual = [&](const Vec18& d) {
      const Vec3 turn = d.segment<3>(3) - tau * d.segment<3>(9) - sag * d.tail<3>();
      const Vec3 y = p + d.head<3>() - (v + d.segment<3>(6)) * tau -
                     (acc + d.segment<3>(12)) * sag + so3::exp(turn) * lever;
      return n.dot(y - c);
    };
    const PointToPlane row{n, lever, tau, sag, residual(Vec18::Zero())};
    const Vec18 j = jacobianOf<18>(row, 1);
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 18; ++k) {
      const double numeric =
          (residual(kStep * Vec18::Unit(k)) - residual(-kStep * Vec18::Unit(k))) / (2 * kStep);
      EXPECT_NEAR(j[k], numeric, 1e-7) << k;
    }
    EXPECT_EQ(jacobianOf<9>(row, 1), j.head<9>());
    EXPECT_EQ(jacobianOf<18>(row, 0).tail<12>().norm(), 0) << "a rigid scan tells no velocity";
  }
}

template <int N>
void expectNoiseOfManyNormals() {
  Random random(8);
  const PointToPlane row{Vec3(1, 2, -0.5).normalized(), Vec3(3, -1, 2), 0.7, 0.4, 0};
  constexpr double kSigma = 0.01;
  constexpr int kRuns = 200'000;
  Eigen::Matrix<double, N, N> sampled = Eigen::Matrix<double, N, N>::Zero();
  for (int i = 0; i < kRuns; ++i) {
    // An error across the normal, isotropic, of this variance in each of the two directions.
    Vec3 error = kSigma * random.vector();
    error -= row.normal * row.normal.dot(error);
    const auto j = jacobianOf<N>({error, row.lever, row.age_s, row.sag_s2, 0}, 1);
    sampled += j * j.transpose() / kRuns;
  }
  PointToPlaneSums<N> noise;
  noise.addNormalNoise(row, 1, kSigma * kSigma, 1);
  EXPECT_LT((noise.information - sampled).norm(), 0.02 * sampled.norm());
}

TEST(PointToPlaneSums, NormalNoiseIsThatOfManyNormals) {
  expectNoiseOfManyNormals<9>();
  expectNoiseOfManyNormals<18>();
}

/// Points on the walls of a place whose normals have an error of 0.02 rad.
struct NoisyScan {
  PointToPlaneSums<9> sums, noise;

  void add(const Vec3& point, const Vec3& normal, Random& random) {
    const Vec3 n = (normal + 0.02 * random.vector()).normalized();
    const PointToPlane row{n, point, random.uniform(0, 0.1), 0, 0.01 * random.normal()};
    sums.add(row, 1e4, 1);
    noise.addNormalNoise(row, 1e4, 4e-4, 1);
  }
};

// The share of a direction that is open.
double openShare(const InformativePart<9>& part, const Vec9& direction) {
  return (part.open().transpose() * direction).norm() / direction.norm();
}

TEST(InformativePart, ATunnelIsOpenAlongItsAxisAndNowhereElse) {
  Random random(9);
  NoisyScan scan;
  for (int i = 0; i < 1500; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const Vec3 inwards(0, -std::cos(angle), -std::sin(angle));
    // Not round, so that it does not turn about its axis.
    scan.add(Vec3(random.uniform(-20, 20), 3 * std::cos(angle), 2 * std::sin(angle)), inwards,
             random);
  }
  const InformativePart<9> part(scan.sums.information, scan.noise.information);
  EXPECT_EQ(part.open().cols(), 2);
  EXPECT_GT(openShare(part, Vec9::Unit(0)), 0.999) << "position along the axis";
  EXPECT_GT(openShare(part, Vec9::Unit(6)), 0.999) << "velocity along the axis";
  const double before = scan.sums.information(0, 0);
  part.apply(scan.sums);
  EXPECT_LT(scan.sums.information(0, 0), 0.02 * before);
  EXPECT_GT(scan.sums.information(1, 1), 1e6) << "across it";
}

// Neither the position alone is open in a circular hall, seen from beside its axis, nor the
// rotation: a turn about its axis is both.
TEST(InformativePart, ACircularHallIsOpenToATurnAboutItsAxis) {
  Random random(11);
  NoisyScan scan;
  const Vec3 axis(2, 1, 0);
  for (int i = 0; i < 1500; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const Vec3 outwards(std::cos(angle), std::sin(angle), 0);
    if (i % 3 == 0) {
      const Vec3 on_floor = axis + random.uniform(1, 6) * outwards;
      scan.add(on_floor - 1.5 * Vec3::UnitZ(), Vec3::UnitZ(), random);
    } else {
      scan.add(axis + 6 * outwards + random.uniform(-1.5, 3) * Vec3::UnitZ(), -outwards, random);
    }
  }
  const InformativePart<9> part(scan.sums.information, scan.noise.information);
  EXPECT_EQ(part.open().cols(), 2);
  Vec9 turn = Vec9::Zero();
  turn.head<3>() = axis.cross(Vec3::UnitZ());
  turn.segment<3>(3) = Vec3::UnitZ();
  EXPECT_GT(openShare(part, turn), 0.999);
  Vec9 velocity = Vec9::Zero();
  velocity.tail<3>() = turn.head<3>();
  EXPECT_GT(openShare(part, velocity), 0.999) << "known no better than the rate";
  part.apply(scan.sums);
  EXPECT_LT(turn.dot(scan.sums.information * turn),
            1e-6 * turn.squaredNorm() * scan.sums.information.trace());
}

TEST(InformativePart, ARoomIsNotOpenAndLosesNothing) {
  Random random(10);
  NoisyScan scan;
  for (int i = 0; i < 1500; ++i) {
    Vec3 point = 4 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const int axis = i % 3;
    const double side = i % 2 == 0 ? 1 : -1;
    point[axis] = 4 * side;
    scan.add(point, -side * Vec3::Unit(axis), random);
  }
  const InformativePart<9> part(scan.sums.information, scan.noise.information);
  EXPECT_EQ(part.open().cols(), 0);
  const Vec6 step =
      scan.sums.information.topLeftCorner<6, 6>().ldlt().solve(scan.sums.gradient.head<6>());
  const Mat9 before = scan.sums.information;
  part.apply(scan.sums);
  const Vec6 same =
      scan.sums.information.topLeftCorner<6, 6>().ldlt().solve(scan.sums.gradient.head<6>());
  EXPECT_LT((step - same).norm(), 0.1 * step.norm() + 1e-6);
  for (int k = 0; k < 6; ++k) EXPECT_GT(scan.sums.information(k, k), 0.9 * before(k, k));
}

}  // namespace
}  // namespace paloc
