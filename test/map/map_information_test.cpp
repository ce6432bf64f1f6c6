#include "paloc/map/map_information.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <iostream>
#include <random>

#include "paloc/core/shared_errors.h"
#include "paloc/map/degeneracy.h"
#include "paloc/map/matcher_settings.h"
#include "simulated_rooms.h"

namespace paloc {
namespace {

std::vector<PlaneRow> randomRows(int count, int patches, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<PlaneRow> rows(static_cast<std::size_t>(count));
  for (PlaneRow& row : rows) {
    row.normal_body = Vec3(normal(random), normal(random), normal(random)).normalized();
    row.point_body = 4 * Vec3(normal(random), normal(random), normal(random));
    row.residual = 1e-4 * normal(random);  // patches agree: their errors are as configured
    row.variance = 1e-4 * (0.5 + uniform(random));
    row.range_factor = 2 * uniform(random) - 1;
    row.patch = static_cast<int>(uniform(random) * (patches + 1)) - 1;
  }
  return rows;
}

Mat6 underSharedErrors(std::span<const PlaneRow> rows, const SharedErrors& shared) {
  return informationUnderSharedErrors(leastSquares(rows).information, sharedSpread(rows, shared));
}

TEST(MapInformation, EqualsTheDenseFormula) {
  std::mt19937 random(3);
  for (double range_bias : {0.0, 0.004}) {
    const std::vector<PlaneRow> rows = randomRows(60, 5, random);
    const SharedErrors shared{{1e-5, 4e-5, 9e-5, 2e-6, 3e-5}, range_bias};
    const auto n = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd jacobian(n, 6), covariance = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd residual(n), own(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const PlaneRow& a = rows[static_cast<std::size_t>(i)];
      jacobian.row(i) = a.jacobian().transpose();
      residual[i] = a.residual;
      own[i] = a.variance;
      covariance(i, i) += a.variance;
      for (Eigen::Index j = 0; j < n; ++j) {
        const PlaneRow& b = rows[static_cast<std::size_t>(j)];
        covariance(i, j) += range_bias * range_bias * a.range_factor * b.range_factor;
        if (a.patch >= 0 && a.patch == b.patch) {
          covariance(i, j) += shared.patch_variances[static_cast<std::size_t>(a.patch)];
        }
      }
    }
    // The estimate is a linear map of the residuals, gain * r: its covariance is gain C gain^T.
    const Eigen::MatrixXd weighted = own.cwiseInverse().asDiagonal() * jacobian;
    const Eigen::MatrixXd hessian = jacobian.transpose() * weighted;
    const Eigen::MatrixXd gain = hessian.ldlt().solve(weighted.transpose());
    const Eigen::MatrixXd expected = (gain * covariance * gain.transpose()).inverse();
    EXPECT_LT((underSharedErrors(rows, shared) - expected).norm(), 1e-9 * expected.norm());
    const NormalEquations equations = leastSquares(rows);
    EXPECT_LT((equations.information - hessian).norm(), 1e-12 * hessian.norm());
    const Eigen::VectorXd gradient = weighted.transpose() * residual;
    EXPECT_LT((equations.gradient - gradient).norm(), 1e-12 * gradient.norm());
    EXPECT_LT((underSharedErrors(rows, {}) - hessian).norm(), 1e-9 * hessian.norm());
  }
}

TEST(MapInformation, NoInformationWhereNoRowFixesADirection) {
  std::mt19937 random(5);
  std::vector<PlaneRow> rows = randomRows(60, 5, random);
  for (PlaneRow& row : rows) {
    row.normal_body.x() = 0;
    row.normal_body.normalize();
  }
  const Mat6 information = underSharedErrors(rows, {{1e-5, 4e-5, 9e-5, 2e-6, 3e-5}, 0.004});
  EXPECT_LT(information.col(0).norm(), 1e-9 * information.norm());
}

TEST(MapInformation, TurnsTranslationIntoTheMap) {
  std::mt19937 random(4);
  const Mat6 body = leastSquares(randomRows(40, 0, random)).information;
  const Mat3 R = so3::exp(Vec3(0.3, -0.8, 1.1));
  Vec6 delta_body, delta_map;
  delta_body << 0.1, -0.2, 0.3, 0.05, 0.02, -0.01;
  delta_map = delta_body;
  delta_map.head<3>() = R * delta_body.head<3>();
  const double expected = delta_body.dot(body * delta_body);
  EXPECT_NEAR(delta_map.dot(informationInMap(body, R) * delta_map), expected, 1e-9 * expected);
}

// Rows of a scan of the empty room against its exact planes, at the truth.
std::vector<PlaneRow> rowsInRoom(const test::BoxWorld& world, const Scan& scan, const Pose& pose,
                                 double range_noise) {
  std::vector<PlaneRow> rows;
  const test::Box& room = world.boxes[0];
  for (const Point3f& p : scan.points_body) {
    PlaneRow row;
    row.point_body =
        Vec3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    const Vec3 at = pose * row.point_body;
    double nearest = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      for (double face : {room.low[axis], room.high[axis]}) {
        if (std::abs(at[axis] - face) > std::abs(nearest)) continue;
        nearest = at[axis] - face;
        row.residual = nearest;
        row.normal_body = pose.rotation.transpose() * Vec3::Unit(axis);
      }
    }
    row.range_factor = row.normal_body.dot(row.point_body.normalized());
    row.variance = std::pow(range_noise * row.range_factor, 2) + 1e-6;
    rows.push_back(row);
  }
  return rows;
}

TEST(MapInformation, CovarianceHoldsUnderSharedBiases) {
  const test::BoxWorld world = test::emptyRoom();
  const Pose truth{Vec3(0.7, -0.4, 1.3), so3::exp(Vec3(0.02, 0.03, 0.6))};
  constexpr int kRuns = 400;
  for (double bias : {0.0, 0.003, 0.005, 0.01}) {
    double nees = 0, plain_nees = 0;
    for (unsigned run = 0; run < kRuns; ++run) {
      const Scan scan = test::simulateScan(world, truth, 3000, {0.02, bias, bias}, 30, 100 + run);
      std::vector<PlaneRow> rows = rowsInRoom(world, scan, truth, 0.02);
      const SharedErrors shared{assignPatches(rows, MatcherSettings().plane_patch_m, bias, 0),
                                bias};
      const NormalEquations plain = leastSquares(rows);
      const Eigen::Matrix<double, 6, 6> hessian = plain.information;
      const Eigen::Matrix<double, 6, 1> gradient = plain.gradient;
      const Vec6 error = hessian.ldlt().solve(gradient);
      nees += error.dot(underSharedErrors(rows, shared) * error) / 6 / kRuns;
      plain_nees += error.dot(plain.information * error) / 6 / kRuns;
    }
    std::cout << "bias " << bias * 1e3 << " mm: NEES/dof " << nees << ", plain sum " << plain_nees
              << "\n";
    EXPECT_GT(nees, 0.8) << bias;
    EXPECT_LT(nees, 1.25) << bias;
    if (bias >= 0.005) {
      EXPECT_GT(plain_nees, 5) << bias;
    }
  }
}

// White noise of the map's points is no error that a surface's points share.
TEST(MapInformation, OnlyThicknessBeyondTheMapsNoiseIsShared) {
  std::vector<PlaneRow> rows(20);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].normal_body = Vec3::UnitX();
    rows[k].point_body = Vec3(2, 0.1 * static_cast<double>(k), 0);
    rows[k].surface_sigma = 0.004;
  }
  EXPECT_DOUBLE_EQ(assignPatches(rows, 10, 0.003, 0.005).at(0), 0.003 * 0.003);
  for (PlaneRow& row : rows) row.surface_sigma = 0.013;
  EXPECT_NEAR(assignPatches(rows, 10, 0.003, 0.005).at(0), 9e-6 + 0.25 * 0.012 * 0.012, 1e-12);
}

// A wall that stands 5 cm from where the map has it draws the pose with it. What is left of the
// contradiction is seen in the residuals, and must be in the covariance.
TEST(MapInformation, AWallThatWasMovedIsInTheCovariance) {
  const test::BoxWorld world = test::emptyRoom();
  const Pose truth{Vec3(0.7, -0.4, 1.3), so3::exp(Vec3(0.02, 0.03, 0.6))};
  const Scan scan = test::simulateScan(world, truth, 3000, {0.02, 0, 0}, 30, 7);
  std::vector<PlaneRow> rows = rowsInRoom(world, scan, truth, 0.02);
  for (PlaneRow& row : rows) {
    const Vec3 normal_map = truth.rotation * row.normal_body;
    if (normal_map.x() > 0.5 && (truth * row.point_body).x() > truth.position.x()) {
      row.residual += 0.05;
    }
  }
  const Eigen::Matrix<double, 6, 6> hessian = leastSquares(rows).information;
  const Eigen::Matrix<double, 6, 1> gradient = leastSquares(rows).gradient;
  const Vec6 error = hessian.ldlt().solve(gradient);
  for (PlaneRow& row : rows) row.residual -= row.jacobian().dot(error);
  EXPECT_GT(error.head<3>().norm(), 0.01);
  const SharedErrors shared{assignPatches(rows, 20, 0.005, 0), 0};
  EXPECT_LT(error.dot(underSharedErrors(rows, shared) * error) / 6, 2);
  for (PlaneRow& row : rows) row.residual = 0;
  EXPECT_GT(error.dot(underSharedErrors(rows, shared) * error) / 6, 2)
      << "the residuals told nothing";
}

}  // namespace
}  // namespace paloc
