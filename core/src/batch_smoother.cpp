#include "paloc/core/batch_smoother.h"

#include <algorithm>
#include <cmath>

#include "paloc/core/chain_solver.h"

namespace paloc {
namespace {

std::vector<ChainBlock> linearizeAll(const std::vector<ChainNode>& nodes, double& cost) {
  std::vector<ChainBlock> blocks;
  blocks.reserve(nodes.size());
  cost = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    blocks.push_back(linearize(k == 0 ? nullptr : &nodes[k - 1], nodes[k]));
    cost += blocks.back().cost;
  }
  return blocks;
}

// Assembles and factorizes H + lambda diag(H); false if it is not positive definite.
bool factorize(const std::vector<ChainBlock>& blocks, double lambda, ChainSolver& solver) {
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    StateMatrix diagonal = blocks[k].hessian_jj;
    StateVector b = blocks[k].b_j;
    if (k + 1 < blocks.size()) {
      diagonal += blocks[k + 1].hessian_ii;
      b += blocks[k + 1].b_i;
    }
    diagonal.diagonal() *= 1 + lambda;
    solver.set(k, diagonal, blocks[k].hessian_ji, b);
  }
  return solver.factorizeFrom(0) == blocks.size();
}

// Moves all states, and returns them as they were.
std::vector<State> moveStates(std::vector<ChainNode>& nodes,
                              const std::vector<StateVector>& delta) {
  std::vector<State> before;
  before.reserve(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    before.push_back(nodes[k].state);
    nodes[k].state = boxplus(nodes[k].state, delta[k]);
    nodes[k].state.T_map_body.rotation = so3::normalized(nodes[k].state.T_map_body.rotation);
  }
  return before;
}

}  // namespace

BatchSummary smoothBatch(std::vector<ChainNode>& nodes, const SmootherSettings& settings) {
  BatchSummary summary;
  if (nodes.empty()) return summary;
  ChainSolver solver;
  for (std::size_t k = 0; k < nodes.size(); ++k) solver.append();

  double cost = 0;
  std::vector<ChainBlock> blocks = linearizeAll(nodes, cost);
  summary.initial_cost = summary.final_cost = cost;
  if (!std::isfinite(cost)) return summary;
  summary.status = BatchSummary::Status::kIterationLimit;
  double lambda = 1e-8;
  std::vector<StateVector> delta;
  while (summary.iterations < settings.batch_max_iterations && lambda < 1e8) {
    ++summary.iterations;
    bool better = false;
    double decrease = 0;
    if (factorize(blocks, lambda, solver)) {
      solver.solve(delta);
      const std::vector<State> before = moveStates(nodes, delta);
      double candidate_cost = 0;
      std::vector<ChainBlock> candidate_blocks = linearizeAll(nodes, candidate_cost);
      better = candidate_cost <= cost;  // false for NaN
      decrease = cost - candidate_cost;
      if (better) {
        blocks.swap(candidate_blocks);
        cost = candidate_cost;
      } else {
        for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k].state = before[k];
      }
    }
    lambda = better ? std::max(1e-12, lambda * 0.1) : std::max(1e-6, lambda * 10);
    if (better && decrease <= settings.batch_convergence * (std::abs(cost) + 1)) {
      summary.status = BatchSummary::Status::kConverged;
      break;
    }
  }
  summary.final_cost = cost;
  if (!factorize(blocks, 0, solver)) {
    summary.status = BatchSummary::Status::kFailed;
    return summary;
  }
  ChainSolver::JointCovariances covariances = solver.jointCovariances();
  summary.covariances = std::move(covariances.own);
  summary.covariances_with_next = std::move(covariances.with_next);
  summary.gains = std::move(covariances.gains);
  return summary;
}

}  // namespace paloc
