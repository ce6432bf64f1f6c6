#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <iostream>
#include <limits>

#include "paloc/core/fixed_lag_smoother.h"
#include "simulated_chain.h"

namespace paloc {
namespace {

using tangent::kDim;

// Moves of the whole window that IMU data cannot see: along x, y and z, and about gravity.
std::vector<Eigen::VectorXd> unseenMoves(const std::vector<ChainNode>& nodes, const Vec3& up_map) {
  const auto n = static_cast<Eigen::Index>(nodes.size()) * kDim;
  std::vector<Eigen::VectorXd> moves(4, Eigen::VectorXd::Zero(n));
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto o = static_cast<Eigen::Index>(k) * kDim;
    const State& x = nodes[k].state;
    for (int axis = 0; axis < 3; ++axis) moves[static_cast<std::size_t>(axis)][o + axis] = 1;
    Eigen::VectorXd& yaw = moves[3];
    yaw.segment<3>(o + tangent::kPosition) = up_map.cross(x.T_map_body.position);
    yaw.segment<3>(o + tangent::kRotation) = x.T_map_body.rotation.transpose() * up_map;
    yaw.segment<3>(o + tangent::kVelocity) = up_map.cross(x.v_map);
    yaw.segment<3>(o + tangent::kGravity) = up_map.cross(x.gravity_map);
  }
  return moves;
}

TEST(Consistency, AnImuOnlyWindowLeavesExactlyPositionAndYawOpen) {
  // What is known: at rest at the start, roughly the biases, gravity. A hair of information on the
  // pose makes the window solvable: it must be all that there is along the unseen moves.
  constexpr double kHair = 1e-2;
  SimulatedChain chain(1);
  SmootherSettings settings;
  settings.lag_s = 1;
  FixedLagSmoother smoother(settings);
  chain.truth.T_map_body = Pose();
  ChainNode first = chain.first();
  StateVector sigma = StateVector::Constant(std::numeric_limits<double>::infinity());
  sigma.segment<3>(tangent::kVelocity).setConstant(0.01);
  sigma.segment<3>(tangent::kBiasAcc).setConstant(0.05);
  sigma.segment<3>(tangent::kBiasGyro).setConstant(0.005);
  sigma.segment<3>(tangent::kGravity).setConstant(1e-3);
  sigma.segment<3>(tangent::kPosition).setConstant(1 / std::sqrt(kHair));
  sigma[tangent::kRotation + 2] = 1 / std::sqrt(kHair);
  first.node_factors.assign(1, PriorFactor::fromSigmas(first.state, sigma));
  first.node_factors.push_back(GravityFactor(Vec3(0, 0, 9.81), 0.01, 0.001));
  smoother.add(first);
  const auto check = [&](const char* when) {
    const std::vector<ChainNode> nodes = smoother.linearizedWindow();
    const DenseSystem system(nodes);
    for (const Eigen::VectorXd& move : unseenMoves(nodes, Vec3::UnitZ())) {
      EXPECT_LE(move.dot(system.hessian * move), 1.05 * kHair + 1e-4) << when;
    }
    // All others are seen: without the four moves, nothing is left that is as weak.
    Eigen::MatrixXd held = system.hessian;
    for (const Eigen::VectorXd& move : unseenMoves(nodes, Vec3::UnitZ())) {
      held += 1e6 * move * move.transpose() / move.squaredNorm();
    }
    const Eigen::VectorXd pivots = held.ldlt().vectorD();
    EXPECT_GT(pivots.minCoeff(), 100 * kHair) << when;
  };
  for (int k = 1; k < 9; ++k) smoother.add(chain.next(smoother.newest().state));
  check("before marginalization");
  for (int k = 9; k < 40; ++k) smoother.add(chain.next(smoother.newest().state));
  EXPECT_EQ(smoother.repairs().total(), 0u);
  check("after marginalization");
}

constexpr unsigned kSeeds = 200;

/// Mean normalised error squared per degree of freedom of parts of the newest state.
struct Nees {
  double pose = 0, velocity = 0, biases = 0, all = 0;
};

double normalizedSquare(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return error.dot(covariance.ldlt().solve(error)) / static_cast<double>(error.size());
}

// Over kSeeds runs whose start and biases are drawn anew; `measure` adds the map's factors to node
// k.
template <class Measure>
Nees neesOfNewest(int nodes, Measure measure) {
  Nees mean;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SimulatedChain chain(seed);
    SmootherSettings settings;
    settings.lag_s = 2;
    settings.covariance_of_leaving = false;
    FixedLagSmoother smoother(settings);
    smoother.add(chain.firstDrawn());
    for (int k = 1; k < nodes; ++k) {
      ChainNode node = chain.next(smoother.newest().state);
      node.edge_factors.push_back(chain.odometry());
      measure(k, chain, node);
      smoother.add(std::move(node));
    }
    const NodeEstimate newest = smoother.newest();
    const StateVector error = boxminus(newest.state, chain.truth);
    const auto part = [&](int offset, int size) {
      return normalizedSquare(error.segment(offset, size),
                              newest.covariance.block(offset, offset, size, size)) /
             kSeeds;
    };
    mean.pose += part(tangent::kPosition, 6);
    mean.velocity += part(tangent::kVelocity, 3);
    mean.biases += part(tangent::kBiasAcc, 6);
    mean.all += part(tangent::kPosition, 15);
  }
  return mean;
}

// 95 % bounds of chi squared with `dof` degrees of freedom over them (Wilson and Hilferty 1931).
void expectWithin95Percent(const char* name, double nees, int dof_of_one) {
  const double dof = kSeeds * dof_of_one;
  const auto bound = [&](double z) {
    return std::pow(1 - 2 / (9 * dof) + z * std::sqrt(2 / (9 * dof)), 3);
  };
  const double low = bound(-1.96), high = bound(1.96);
  std::cout << "  " << name << ": NEES/dof " << nees << ", 95 % bounds " << low << " to " << high
            << "\n";
  EXPECT_GT(nees, low) << name;
  EXPECT_LT(nees, high) << name;
}

void expectConsistent(const Nees& nees) {
  expectWithin95Percent("pose", nees.pose, 6);
  expectWithin95Percent("velocity", nees.velocity, 3);
  expectWithin95Percent("biases", nees.biases, 6);
  expectWithin95Percent("pose, velocity and biases", nees.all, 15);
}

TEST(Consistency, NeesWithMapFactors) {
  expectConsistent(neesOfNewest(150, [](int, SimulatedChain& chain, ChainNode& node) {
    node.node_factors.push_back(chain.map(chain.truth));
  }));
}

TEST(Consistency, NeesThroughTwentySecondsWithoutAMap) {
  expectConsistent(neesOfNewest(250, [](int k, SimulatedChain& chain, ChainNode& node) {
    if (k < 50) node.node_factors.push_back(chain.map(chain.truth));
  }));
}

TEST(Consistency, NeesWithOneDirectionMissing) {
  expectConsistent(neesOfNewest(150, [](int, SimulatedChain& chain, ChainNode& node) {
    const Vec3 open = Vec3(1, 1, 0).normalized();  // a corridor at 45 degrees
    Mat6 information = Mat6::Zero();
    information.topLeftCorner<3, 3>() =
        (Mat3::Identity() - open * open.transpose()) / (0.02 * 0.02);
    information.bottomRightCorner<3, 3>() = Mat3::Identity() / (0.004 * 0.004);
    Vec6 error;
    error << chain.random.vector(0.02) + 5 * open, chain.random.vector(0.004);
    node.node_factors.push_back(MapFactor(boxplus(chain.truth.T_map_body, error), information));
  }));
}

}  // namespace
}  // namespace paloc
