#include "paloc/core/map_correlation.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "paloc/core/chain.h"
#include "paloc/core/mrpt_pose.h"
#include "random_states.h"

namespace paloc {
namespace {

constexpr double kDistance_m = 10;

std::vector<Vec3> walk(std::size_t nodes, double step_m) {
  std::vector<Vec3> positions;
  for (std::size_t k = 0; k < nodes; ++k) {
    positions.emplace_back(step_m * static_cast<double>(k), 1, 2);
  }
  return positions;
}

TEST(MapCorrelation, OnAnEvenWalkTheSumIsThatOfTheExponential) {
  const std::vector<Vec3> positions = walk(2001, 0.11);
  const std::vector<bool> all(positions.size(), true);
  const std::vector<double> scans = scansSharingErrors(positions, all, kDistance_m);
  const double ratio = std::exp(-0.11 / kDistance_m);
  EXPECT_NEAR(scans[1000], (1 + ratio) / (1 - ratio), 0.01 * scans[1000]);
  EXPECT_NEAR(scans[0], 1 / (1 - ratio), 0.01 * scans[0]);
  EXPECT_NEAR(scans[0], scans[2000], 1e-9 * scans[0]);
}

TEST(MapCorrelation, OnlineItIsTheSameOnAWalkThatGoesOn) {
  ScanCorrelation correlation(kDistance_m);
  double scans = 0;
  for (const Vec3& position : walk(2000, 0.11)) scans = correlation.add(position, 0.1);
  const double ratio = std::exp(-0.11 / kDistance_m);
  EXPECT_NEAR(scans, (1 + ratio) / (1 - ratio), 0.01 * scans);
}

// What all scans of a rest say together is what one says.
TEST(MapCorrelation, AtRestAllScansAreOne) {
  RandomStates random(3);
  std::vector<Vec3> positions(300, Vec3(1, 2, 3));
  for (Vec3& position : positions) position += random.vector(0.002);
  std::vector<bool> some(positions.size(), true);
  for (std::size_t k = 0; k < some.size(); k += 3) some[k] = false;
  const std::vector<double> scans = scansSharingErrors(positions, some, kDistance_m);
  double together = 0;
  for (std::size_t k = 0; k < scans.size(); ++k) together += some[k] ? 1 / scans[k] : 0;
  EXPECT_NEAR(together, 1, 1e-9);
  EXPECT_EQ(scans[0], 1) << "has no map factor";
}

MapMatch matchWith(const Mat6& own, const Mat6& spread) {
  MapMatch match;
  match.T_map_body = toMrpt(Pose());
  match.information = own;
  match.shared_spread = spread;
  return match;
}

// N scans with errors of their own and one that they share: the mean of all has the covariance that
// N factors among N say together.
TEST(MapCorrelation, FactorsTogetherSayWhatTheMeanOfTheScansDoes) {
  constexpr double kScans = 40;
  RandomStates random(4);
  Eigen::Matrix<double, 6, 6> own = Eigen::Matrix<double, 6, 6>::Zero(), spread = own;
  for (int k = 0; k < 12; ++k) {
    Vec6 row;
    row << random.vector(1), random.vector(1);
    own += row * row.transpose();
    if (k < 3) spread += 5 * row * row.transpose();
  }
  const Eigen::Matrix<double, 6, 6> shared = own.inverse() * spread * own.inverse();
  const Eigen::Matrix<double, 6, 6> mean = own.inverse() / kScans + shared;
  const Mat6 together = kScans * matchWith(own, spread).informationAmong(kScans);
  EXPECT_LT((together - mean.inverse()).norm(), 1e-8 * together.norm());
}

// A scan on its own that is right must not be weakened by the kernel, however many share its
// errors; one that is ten standard deviations off must be.
TEST(MapCorrelation, TheKernelRefersToAScanOnItsOwn) {
  const Mat6 own = 1e6 * Mat6::Identity(), spread = 9e6 * Mat6::Identity();  // sigma 3.2 mm
  const MapFactor factor = mapFactorOf(matchWith(own, spread), 100, 4);
  const auto weightOf = [&](double error) {
    ChainNode node;
    node.state.T_map_body.position.x() = error;
    node.node_factors.emplace_back(factor);
    const double robust = linearize(nullptr, node).b_j[0];
    ChainNode plain = node;
    plain.node_factors.assign(1, MapFactor(Pose(), matchWith(own, spread).informationAmong(100)));
    return robust / linearize(nullptr, plain).b_j[0];
  };
  EXPECT_NEAR(weightOf(3 * 0.00316), 1, 1e-9);
  EXPECT_NEAR(weightOf(10 * 0.00316), 0.4, 0.02);
}

// From one, where no errors are shared, to all scans, where there are no others.
TEST(MapCorrelation, OneAmongScansWeighsWhatItSharesWithThem) {
  const Mat6 own = 1e6 * Mat6::Identity();
  EXPECT_NEAR(scansForOne(matchWith(own, Mat6::Zero()), 50), 1, 1e-9);
  EXPECT_NEAR(scansForOne(matchWith(own, 1e12 * Mat6::Identity()), 50), 50, 1e-3);
  const MapMatch half = matchWith(own, own);
  EXPECT_NEAR(scansForOne(half, 50), 25.5, 1e-6);
  const MapFactor factor = mapFactorOfOneAmong(half, 50, 4);
  ChainNode node;
  node.node_factors.emplace_back(factor);
  const StateMatrix hessian = linearize(nullptr, node).hessian_jj;
  EXPECT_NEAR(hessian(0, 0), 0.5e6 / 25.5, 1);
}

}  // namespace
}  // namespace paloc
