#include "paloc/core/chain_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <deque>
#include <random>

namespace paloc {
namespace {

using tangent::kDim;

/// A random chain, kept beside the solver as dense blocks.
class DenseChain {
 public:
  explicit DenseChain(unsigned seed) : rng_(seed) {}

  StateMatrix random() {
    std::normal_distribution<double> normal;
    return StateMatrix::NullaryExpr([&] { return normal(rng_); });
  }
  StateVector randomVector() { return random().col(0); }

  // A positive definite chain: each edge adds J^T J for J over both blocks.
  void append() {
    diagonal.push_back(StateMatrix::Identity());
    off_diagonal.push_back(StateMatrix::Zero());
    b.push_back(randomVector());
    if (diagonal.size() > 1) changeEdge(diagonal.size() - 1);
  }
  void changeEdge(std::size_t k) {
    const StateMatrix ji = random(), jj = random();
    diagonal[k - 1] += ji.transpose() * ji;
    diagonal[k] += jj.transpose() * jj;
    off_diagonal[k] += jj.transpose() * ji;
    b[k] = randomVector();
    b[k - 1] = randomVector();
  }
  Eigen::MatrixXd hessian() const {
    const auto n = static_cast<Eigen::Index>(diagonal.size()) * kDim;
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t k = 0; k < diagonal.size(); ++k) {
      const auto o = static_cast<Eigen::Index>(k) * kDim;
      h.block<kDim, kDim>(o, o) = diagonal[k];
      if (k == 0) continue;
      h.block<kDim, kDim>(o, o - kDim) = off_diagonal[k];
      h.block<kDim, kDim>(o - kDim, o) = off_diagonal[k].transpose();
    }
    return h;
  }
  Eigen::VectorXd rhs() const {
    Eigen::VectorXd v(static_cast<Eigen::Index>(b.size()) * kDim);
    for (std::size_t k = 0; k < b.size(); ++k) {
      v.segment<kDim>(static_cast<Eigen::Index>(k) * kDim) = b[k];
    }
    return v;
  }
  void setOn(ChainSolver& solver, std::size_t first) const {
    for (std::size_t k = first; k < diagonal.size(); ++k) {
      solver.set(k, diagonal[k], off_diagonal[k], b[k]);
    }
  }
  std::size_t pick(std::size_t below) { return rng_() % below; }

  std::deque<StateMatrix> diagonal, off_diagonal;
  std::deque<StateVector> b;

 private:
  std::mt19937_64 rng_;
};

double solutionError(ChainSolver& solver, const DenseChain& chain) {
  std::vector<StateVector> delta;
  solver.solve(delta);
  const Eigen::VectorXd expected = chain.hessian().ldlt().solve(chain.rhs());
  double worst = 0;
  for (std::size_t k = 0; k < delta.size(); ++k) {
    const auto part = expected.segment<kDim>(static_cast<Eigen::Index>(k) * kDim);
    worst = std::max(worst, (delta[k] - part).norm());
  }
  return worst / std::max(1.0, expected.norm());
}

TEST(ChainSolver, GrowsChangesAndForgetsLikeTheDenseSolution) {
  DenseChain chain(1);
  ChainSolver solver;
  for (int step = 0; step < 300; ++step) {
    chain.append();
    solver.append();
    std::size_t first = chain.diagonal.size() < 2 ? 0 : chain.diagonal.size() - 2;
    if (step % 5 == 0 && chain.diagonal.size() > 2) {
      const std::size_t k = 1 + chain.pick(chain.diagonal.size() - 1);
      chain.changeEdge(k);
      first = std::min(first, k - 1);
    }
    chain.setOn(solver, first);
    ASSERT_EQ(solver.factorizeFrom(first), solver.size());
    if (step % 10 == 0) {
      ASSERT_LT(solutionError(solver, chain), 1e-10) << step;
    }
    if (chain.diagonal.size() < 12) continue;
    // Dropping the front must be the Schur complement: the dense chain is given what the solver
    // says.
    StateMatrix information;
    StateVector b;
    solver.eliminationOfFront(information, b);
    const Eigen::PartialPivLU<StateMatrix> front(chain.diagonal[0]);
    const StateMatrix schur =
        -(chain.off_diagonal[1] * front.solve(chain.off_diagonal[1].transpose()));
    ASSERT_LT((information - schur).norm(), 1e-9 * schur.norm());
    chain.diagonal[1] += schur;
    chain.b[1] -= chain.off_diagonal[1] * front.solve(chain.b[0]);
    chain.diagonal.pop_front();
    chain.off_diagonal.pop_front();
    chain.b.pop_front();
    solver.dropFront();
    solver.set(0, chain.diagonal[0], StateMatrix::Zero(), chain.b[0]);
    ASSERT_LT(solutionError(solver, chain), 1e-10) << "after dropping, step " << step;
  }
}

TEST(ChainSolver, LongWindowsReallocate) {
  DenseChain chain(2);
  ChainSolver solver;
  for (int k = 0; k < 130; ++k) {
    chain.append();
    solver.append();
    const std::size_t first = k == 0 ? 0 : static_cast<std::size_t>(k - 1);
    chain.setOn(solver, first);
    ASSERT_EQ(solver.factorizeFrom(first), solver.size());
  }
  EXPECT_LT(solutionError(solver, chain), 1e-10);
}

TEST(ChainSolver, CovariancesAreBlocksOfTheInverse) {
  DenseChain chain(3);
  ChainSolver solver;
  for (int k = 0; k < 8; ++k) {
    chain.append();
    solver.append();
  }
  chain.setOn(solver, 0);
  ASSERT_EQ(solver.factorizeFrom(0), 8u);
  const Eigen::MatrixXd inverse = chain.hessian().inverse();
  const std::vector<StateMatrix> covariances = solver.covariances();
  for (std::size_t k = 0; k < 8; ++k) {
    const auto o = static_cast<Eigen::Index>(k) * kDim;
    EXPECT_LT((covariances[k] - inverse.block<kDim, kDim>(o, o)).norm(), 1e-10);
    EXPECT_LT((solver.covariance(k) - covariances[k]).norm(), 1e-14);
  }
  EXPECT_LT((solver.newestCovariance() - covariances.back()).norm(), 1e-12);
}

TEST(ChainSolver, TellsWhereItIsNotPositiveDefinite) {
  DenseChain chain(4);
  ChainSolver solver;
  for (int k = 0; k < 5; ++k) {
    chain.append();
    solver.append();
  }
  chain.diagonal[3] -= 1e3 * StateMatrix::Identity();
  chain.setOn(solver, 0);
  EXPECT_EQ(solver.factorizeFrom(0), 3u);
  chain.diagonal[3] += 1e3 * StateMatrix::Identity();
  chain.setOn(solver, 3);
  EXPECT_EQ(solver.factorizeFrom(3), 5u);
  EXPECT_LT(solutionError(solver, chain), 1e-10);
}

}  // namespace
}  // namespace paloc
