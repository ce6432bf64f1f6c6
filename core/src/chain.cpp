#include "paloc/core/chain.h"

#include <cmath>

namespace paloc {
namespace {

/// A Jacobian by its blocks of three columns that are not zero: most of them are.
template <int M>
class SparseJacobian {
 public:
  explicit SparseJacobian(const Eigen::Matrix<double, M, tangent::kDim>& dense) : dense_(dense) {
    for (int offset = 0; offset < tangent::kDim; offset += 3) {
      if (!dense.template middleCols<3>(offset).isZero(0)) offsets_[count_++] = offset;
    }
  }

  /// hessian += weight J^T J
  void addSquareTo(double weight, StateMatrix& hessian) const {
    for (int p = 0; p < count_; ++p) {
      for (int q = 0; q <= p; ++q) {
        const Mat3 product = weight * block(p).transpose().lazyProduct(block(q));
        hessian.block<3, 3>(offsets_[p], offsets_[q]) += product;
        if (p != q) hessian.block<3, 3>(offsets_[q], offsets_[p]) += product.transpose();
      }
    }
  }
  /// hessian += weight J^T K
  void addProductTo(double weight, const SparseJacobian& k, StateMatrix& hessian) const {
    for (int p = 0; p < count_; ++p) {
      for (int q = 0; q < k.count_; ++q) {
        hessian.block<3, 3>(offsets_[p], k.offsets_[q]) +=
            weight * block(p).transpose().lazyProduct(k.block(q));
      }
    }
  }
  /// b -= weight J^T r
  void addGradientTo(double weight, const Eigen::Matrix<double, M, 1>& r, StateVector& b) const {
    for (int p = 0; p < count_; ++p) {
      b.segment<3>(offsets_[p]) -= weight * block(p).transpose().lazyProduct(r);
    }
  }

 private:
  auto block(int p) const { return dense_.template middleCols<3>(offsets_[p]); }

  const Eigen::Matrix<double, M, tangent::kDim>& dense_;
  int offsets_[tangent::kDim / 3];
  int count_ = 0;
};

void addNodeFactor(const PriorFactor& factor, const State& x, ChainBlock& block) {
  block.cost += factor.addTo(x, block.hessian_jj, block.b_j);
}

template <class Factor>
void addNodeFactor(const Factor& factor, const State& x, ChainBlock& block) {
  const auto l = factor.linearize(x);
  const double squared_norm = l.residual.squaredNorm();
  const RobustKernel kernel = factor.kernel();
  const double weight = std::pow(kernel.sqrtWeight(squared_norm), 2);
  const SparseJacobian<decltype(l)::kRows> jacobian(l.jacobian);
  jacobian.addSquareTo(weight, block.hessian_jj);
  jacobian.addGradientTo(weight, l.residual, block.b_j);
  block.cost += kernel.cost(squared_norm);
}

template <class Factor>
void addEdgeFactor(const Factor& factor, const State& i, const State& j, ChainBlock& block) {
  const auto l = factor.linearize(i, j);
  const double squared_norm = l.residual.squaredNorm();
  const RobustKernel kernel = factor.kernel();
  const double weight = std::pow(kernel.sqrtWeight(squared_norm), 2);
  const SparseJacobian<decltype(l)::kRows> jacobian_i(l.jacobian_i), jacobian_j(l.jacobian_j);
  jacobian_i.addSquareTo(weight, block.hessian_ii);
  jacobian_j.addProductTo(weight, jacobian_i, block.hessian_ji);
  jacobian_j.addSquareTo(weight, block.hessian_jj);
  jacobian_i.addGradientTo(weight, l.residual, block.b_i);
  jacobian_j.addGradientTo(weight, l.residual, block.b_j);
  block.cost += kernel.cost(squared_norm);
}

}  // namespace

bool ChainBlock::usable() const {
  // Below a tenth of a nanometre and of a nanoradian: nothing that was measured is so sure.
  constexpr double kAbsurdInformation = 1e20;
  return hessian_jj.allFinite() && hessian_ji.allFinite() && hessian_ii.allFinite() &&
         b_j.allFinite() && b_i.allFinite() && std::isfinite(cost) &&
         hessian_jj.diagonal().maxCoeff() < kAbsurdInformation;
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
