#include "paloc/core/constant_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <iostream>

#include "paloc/core/batch_smoother.h"
#include "paloc/core/map_correlation.h"
#include "paloc/core/surface_errors.h"
#include "simulated_chain.h"

namespace paloc {
namespace {

using tangent::kDim;

struct SmoothedChain {
  std::vector<ChainNode> nodes;
  std::vector<State> truth;
  ChainSolver::JointCovariances covariances;

  void smooth() {
    BatchSummary summary = smoothBatch(nodes, SmootherSettings());
    covariances = {std::move(summary.covariances), std::move(summary.covariances_with_next),
                   std::move(summary.gains)};
  }
};

SmoothedChain chainOf(std::size_t count, unsigned seed) {
  SimulatedChain chain(seed);
  SmoothedChain smoothed;
  smoothed.nodes.push_back(chain.firstDrawn());
  smoothed.truth.push_back(chain.truth);
  while (smoothed.nodes.size() < count) {
    ChainNode node = chain.next(smoothed.nodes.back().state);
    node.node_factors.push_back(chain.map(chain.truth));
    smoothed.nodes.push_back(node);
    smoothed.truth.push_back(chain.truth);
  }
  smoothed.smooth();
  return smoothed;
}

Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& hessian) {
  const Eigen::VectorXd scale = hessian.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  return scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
}

Mat6 randomSquare(RandomStates& random, double size) {
  Mat6 square = Mat6::Zero();
  for (int k = 0; k < 3; ++k) {
    Vec6 v;
    v << random.vector(size), 0.2 * random.vector(size);
    square += v * v.transpose();
  }
  return square;
}

// Every entry in units of the standard deviations that belong to it.
double differenceInSigmas(const StateMatrix& a, const StateMatrix& b, const StateMatrix& rows,
                          const StateMatrix& columns) {
  const StateVector by_row = rows.diagonal().cwiseSqrt().cwiseInverse(),
                    by_column = columns.diagonal().cwiseSqrt().cwiseInverse();
  return (by_row.asDiagonal() * (a - b) * by_column.asDiagonal()).cwiseAbs().maxCoeff();
}

TEST(ConstantErrors, CovariancesAreThoseOfTheDenseFormula) {
  constexpr std::size_t kNodes = 30;
  SmoothedChain chain = chainOf(kNodes, 1);
  RandomStates random(2);
  const Eigen::MatrixXd p = inverseOf(DenseSystem(chain.nodes).hessian);
  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(p.rows(), p.cols());
  std::vector<Mat6> white(kNodes, Mat6::Zero());
  for (std::size_t k = 1; k < kNodes; ++k) {
    white[k] = randomSquare(random, 20);
    const auto o = static_cast<Eigen::Index>(k) * kDim;
    noise.block<6, 6>(o, o) -= white[k];
  }
  std::vector<ConstantError> errors(4);
  for (std::size_t j = 0; j < errors.size(); ++j) {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(p.rows());
    for (std::size_t k = 2 + 3 * j; k < kNodes; k += j == 3 ? 9 : 1) {
      NodeGradient share{k};
      share.gradient << random.vector(40), random.vector(100);
      u.segment<6>(static_cast<Eigen::Index>(k) * kDim) = share.gradient;
      errors[j].push_back(share);
    }
    noise += u * u.transpose();
  }
  errors.emplace_back();  // one that acts nowhere
  const Eigen::MatrixXd expected = p + p * noise * p;
  considerConstantErrors(white, errors, chain.covariances);
  for (std::size_t k = 0; k < kNodes; ++k) {
    const auto o = static_cast<Eigen::Index>(k) * kDim;
    const auto blockAt = [&](Eigen::Index row, Eigen::Index column) -> StateMatrix {
      return expected.block<kDim, kDim>(row, column);
    };
    EXPECT_LT(
        differenceInSigmas(chain.covariances.own[k], blockAt(o, o), blockAt(o, o), blockAt(o, o)),
        1e-5)
        << k;
    if (k + 1 == kNodes) continue;
    const auto next = o + kDim;
    EXPECT_LT(differenceInSigmas(chain.covariances.with_next[k], blockAt(o, next), blockAt(o, o),
                                 blockAt(next, next)),
              1e-5)
        << k;
  }
}

// P u of the chain, by its own solver.
std::vector<StateVector> effectOf(const std::vector<ChainNode>& nodes,
                                  const std::vector<StateVector>& u) {
  std::vector<ChainBlock> blocks;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    blocks.push_back(linearize(k == 0 ? nullptr : &nodes[k - 1], nodes[k]));
  }
  ChainSolver solver;
  for (std::size_t k = 0; k < nodes.size(); ++k) solver.append();
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    StateMatrix diagonal = blocks[k].hessian_jj;
    if (k + 1 < nodes.size()) diagonal += blocks[k + 1].hessian_ii;
    solver.set(k, diagonal, blocks[k].hessian_ji, u[k]);
  }
  EXPECT_EQ(solver.factorizeFrom(0), nodes.size());
  std::vector<StateVector> effect;
  solver.solve(effect);
  return effect;
}

TEST(ConstantErrors, WhatIsLeftOutFarAwayIsNothing) {
  constexpr std::size_t kNodes = 600;
  SmoothedChain chain = chainOf(kNodes, 3);
  std::vector<ConstantError> errors(1);  // in two stretches, far apart
  std::vector<StateVector> u(kNodes, StateVector::Zero());
  for (const std::size_t first : {std::size_t{100}, std::size_t{400}}) {
    for (std::size_t k = first; k < first + 30; ++k) {
      NodeGradient share{k};
      share.gradient << 3, -4, 5, 30, 20, 10;
      u[k].head<6>() = share.gradient;
      errors[0].push_back(share);
    }
  }
  const std::vector<StateVector> effect = effectOf(chain.nodes, u);
  const std::vector<StateMatrix> own = chain.covariances.own;
  considerConstantErrors(std::vector<Mat6>(kNodes, Mat6::Zero()), errors, chain.covariances);
  for (std::size_t k = 0; k < kNodes; ++k) {
    const StateMatrix expected = own[k] + effect[k] * effect[k].transpose();
    EXPECT_LT(differenceInSigmas(chain.covariances.own[k], expected, expected, expected), 1e-3)
        << k;
  }
}

/// A surface by its number, and its normal, or what else its shift moves.
MapMatch matchUnder(const std::vector<Vec6>& gradients, const std::vector<int>& surfaces,
                    const Mat6& own, double bias_m) {
  MapMatch match;
  match.refusal = MatchRefusal::kNone;
  match.information = own;
  match.surface_bias_m = bias_m;
  auto seen = std::make_shared<std::vector<SurfaceGradient>>();
  for (const int surface : surfaces) {
    const Vec6& gradient = gradients[static_cast<std::size_t>(surface)];
    match.shared_spread += bias_m * bias_m * gradient * gradient.transpose();
    seen->push_back({surface, gradient});
  }
  match.surfaces = seen;
  return match;
}

// Walks past surfaces whose shifts are drawn anew each time, three of them in sight: with the
// factors' guess of how many scans share them too low, or as high as it is, the covariance holds.
TEST(ConstantErrors, TheCovarianceHoldsWhateverTheFactorsTookTheErrorsFor) {
  constexpr std::size_t kNodes = 80, kSurfaces = 12, kInSight = 20;
  constexpr double kBias_m = 0.01;
  constexpr unsigned kRuns = 60;
  const Mat6 own = (Vec6() << Vec3::Constant(4e6), Vec3::Constant(4e7)).finished().asDiagonal();
  for (const double scans : {4.0, 100.0}) {
    double nees = 0, as_white = 0;
    for (unsigned run = 1; run <= kRuns; ++run) {
      RandomStates random(1000 + run);
      std::vector<Vec6> gradients(kSurfaces);
      std::vector<double> shifts;
      for (std::size_t j = 0; j < kSurfaces; ++j) {
        gradients[j] << 1.3e6 * Vec3::Unit(static_cast<int>(j % 3)), random.vector(1e6);
        shifts.push_back(random.normal(kBias_m));
      }
      SimulatedChain simulated(run);
      SmoothedChain chain;
      SurfaceErrors errors(kNodes);
      for (std::size_t k = 0; k < kNodes; ++k) {
        ChainNode node = k == 0 ? simulated.firstDrawn() : simulated.next(chain.nodes.back().state);
        std::vector<int> surfaces;
        Vec6 error;
        error << random.vector(5e-4), random.vector(1.6e-4);
        for (std::size_t j = 0; j < kSurfaces; ++j) {
          const double at = static_cast<double>(kNodes * (j / 3)) / (kSurfaces / 3.0 - 1);
          if (std::abs(static_cast<double>(k) - at) > kInSight) continue;
          surfaces.push_back(static_cast<int>(j));
          error += shifts[j] * (own.diagonal().cwiseInverse().asDiagonal() * gradients[j]);
        }
        const MapMatch match = matchUnder(gradients, surfaces, own, kBias_m);
        node.node_factors.push_back(
            MapFactor(boxplus(simulated.truth.T_map_body, error),
                      match.informationAmong(1) / scansForOne(match, scans)));
        errors.add(k, match, scans, 1);
        chain.nodes.push_back(node);
        chain.truth.push_back(simulated.truth);
      }
      chain.smooth();
      const auto normalized = [&](std::size_t k) {
        const Eigen::Matrix<double, 6, 6> covariance =
            chain.covariances.own[k].topLeftCorner<6, 6>();
        const Eigen::Matrix<double, 6, 1> off =
            boxminus(chain.nodes[k].state.T_map_body, chain.truth[k].T_map_body);
        return off.dot(covariance.ldlt().solve(off)) / (6.0 * kRuns * 4);
      };
      for (std::size_t k = 10; k < kNodes; k += 20) as_white += normalized(k);
      considerConstantErrors(errors.takenAsWhite(), errors.constant(), chain.covariances);
      for (std::size_t k = 10; k < kNodes; k += 20) nees += normalized(k);
    }
    std::cout << "among " << scans << " scans: NEES/dof " << nees << ", before " << as_white
              << "\n";
    EXPECT_NEAR(nees, 1, 0.15) << scans;
    if (scans < 10) {
      EXPECT_GT(as_white, 2) << "too few";
    }
  }
}

}  // namespace
}  // namespace paloc
