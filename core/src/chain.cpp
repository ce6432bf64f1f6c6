#include "paloc/core/chain.h"

#include <cmath>

namespace paloc {
namespace {

void addNodeFactor(const PriorFactor& factor, const State& x, ChainBlock& block) {
  block.cost += factor.addTo(x, block.hessian_jj, block.b_j);
}

template <class Factor>
void addNodeFactor(const Factor& factor, const State& x, ChainBlock& block) {
  auto l = factor.linearize(x);
  const double squared_norm = l.residual.squaredNorm();
  const RobustKernel kernel = factor.kernel();
  const double weight = std::pow(kernel.sqrtWeight(squared_norm), 2);
  block.hessian_jj.noalias() += weight * (l.jacobian.transpose() * l.jacobian);
  block.b_j.noalias() -= weight * (l.jacobian.transpose() * l.residual);
  block.cost += kernel.cost(squared_norm);
}

template <class Factor>
void addEdgeFactor(const Factor& factor, const State& i, const State& j, ChainBlock& block) {
  const auto l = factor.linearize(i, j);
  const double squared_norm = l.residual.squaredNorm();
  const RobustKernel kernel = factor.kernel();
  const double weight = std::pow(kernel.sqrtWeight(squared_norm), 2);
  block.hessian_ii.noalias() += weight * (l.jacobian_i.transpose() * l.jacobian_i);
  block.hessian_ji.noalias() += weight * (l.jacobian_j.transpose() * l.jacobian_i);
  block.hessian_jj.noalias() += weight * (l.jacobian_j.transpose() * l.jacobian_j);
  block.b_i.noalias() -= weight * (l.jacobian_i.transpose() * l.residual);
  block.b_j.noalias() -= weight * (l.jacobian_j.transpose() * l.residual);
  block.cost += kernel.cost(squared_norm);
}

}  // namespace

bool ChainBlock::allFinite() const {
  return hessian_jj.allFinite() && hessian_ji.allFinite() && hessian_ii.allFinite() &&
         b_j.allFinite() && b_i.allFinite() && std::isfinite(cost);
}

ChainBlock linearizeEdge(const ChainNode& previous, const ChainNode& node) {
  ChainBlock block;
  for (const EdgeFactor& factor : node.edge_factors) {
    std::visit([&](const auto& f) { addEdgeFactor(f, previous.state, node.state, block); }, factor);
  }
  return block;
}

ChainBlock linearize(const ChainNode* previous, const ChainNode& node) {
  ChainBlock block = previous ? linearizeEdge(*previous, node) : ChainBlock();
  for (const NodeFactor& factor : node.node_factors) {
    std::visit([&](const auto& f) { addNodeFactor(f, node.state, block); }, factor);
  }
  return block;
}

}  // namespace paloc
