#include "paloc/core/chain_solver.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>

#include "chain_cholesky.h"

namespace paloc {
namespace {

using tangent::kDim;

constexpr std::size_t kN = ChainCholesky::kN;

using ConstSegment = Eigen::Map<const Eigen::VectorXd>;

// The window of a vector with `entries` numbers a block moves from the block `from` to the front.
void moveToFront(std::vector<double>& values, std::size_t from, std::size_t blocks,
                 std::size_t entries, std::size_t capacity) {
  const auto start = values.begin() + static_cast<std::ptrdiff_t>(from * entries);
  std::copy_n(start, blocks * entries, values.begin());
  values.resize(capacity * entries, 0.0);
}

}  // namespace

struct ChainSolver::Impl {
  ChainCholesky factor;
  std::vector<double> b;  // right-hand side, by place
  // Kept from one solution to the next, for places before z_valid: L z = b, and with them
  //   delta(k) = y(k) - G(k) delta(k+1),  y = L(k,k)^-T D^-1 z,  G = (L(k+1,k) L(k,k)^-1)^T,
  // so that back-substitution is one product a block.
  std::vector<double> z, y, g;
  std::size_t z_valid = 0;

  Impl() { follow(0, 0); }
  void follow(std::size_t begin_before, std::size_t count_before);
  void forward(std::size_t place);
  void prepareBackward(std::size_t place);
  template <class Visitor>
  void recurseCovariances(std::size_t first, Visitor visit) const;
};

// After the factor has moved its window to the front of its arrays, ours follow.
void ChainSolver::Impl::follow(std::size_t begin_before, std::size_t count_before) {
  for (std::vector<double>* values : {&b, &z, &y}) {
    moveToFront(*values, begin_before, count_before, kN, factor.capacity());
  }
  moveToFront(g, begin_before, count_before, kN * kN, factor.capacity());
  z_valid -= std::min(z_valid, begin_before);
}

ChainSolver::ChainSolver() : impl_(std::make_unique<Impl>()) {}
ChainSolver::~ChainSolver() = default;
ChainSolver::ChainSolver(ChainSolver&&) noexcept = default;
ChainSolver& ChainSolver::operator=(ChainSolver&&) noexcept = default;

std::size_t ChainSolver::size() const { return impl_->factor.count(); }

void ChainSolver::clear() {
  impl_->factor.clear();
  impl_->z_valid = 0;
}

void ChainSolver::append() {
  Impl& s = *impl_;
  const std::size_t begin = s.factor.begin(), count = s.factor.count();
  const std::size_t capacity = s.factor.capacity();
  s.factor.append();
  if (s.factor.begin() != begin || s.factor.capacity() != capacity) s.follow(begin, count);
}

void ChainSolver::set(std::size_t k, const StateMatrix& diagonal, const StateMatrix& off_diagonal,
                      const StateVector& b) {
  Impl& s = *impl_;
  const std::size_t place = s.factor.begin() + k;
  s.factor.set(place, diagonal, off_diagonal);
  Eigen::Map<StateVector>(s.b.data() + place * kN) = b;
}

std::size_t ChainSolver::factorizeFrom(std::size_t first) {
  Impl& s = *impl_;
  const std::size_t place = s.factor.begin() + first;
  s.z_valid = std::min(s.z_valid, place);
  return s.factor.factorizeFrom(place) - s.factor.begin();
}

// L z = b from `place` on, and what back-substitution needs of it.
void ChainSolver::Impl::forward(std::size_t place) {
  const std::size_t begin = factor.begin(), end = factor.end();
  if (place >= end) return;
  for (std::size_t q = std::max(place, begin); q < end; ++q) {
    Eigen::Map<StateVector> zq(z.data() + q * kN);
    zq = Eigen::Map<const StateVector>(b.data() + q * kN);
    if (q > begin) {
      for (std::size_t c = 0; c < kN; ++c) {
        zq -=
            z[(q - 1) * kN + c] * Eigen::Map<const StateVector>(factor.column(q - 1, c) + (kN - c));
      }
    }
    for (std::size_t c = 0; c + 1 < kN; ++c) {
      const auto below = static_cast<Eigen::Index>(kN - c - 1);
      zq.tail(below) -=
          zq[static_cast<Eigen::Index>(c)] * ConstSegment(factor.column(q, c) + 1, below);
    }
  }
  // The block before the first new row is coupled to it.
  for (std::size_t q = std::max(place, begin + 1) - 1; q < end; ++q) prepareBackward(q);
  z_valid = end;
}

void ChainSolver::Impl::prepareBackward(std::size_t place) {
  Eigen::Map<StateVector> yq(y.data() + place * kN);
  for (std::size_t c = kN; c-- > 0;) {
    const double* l = factor.column(place, c);
    const auto row = static_cast<Eigen::Index>(c), below = static_cast<Eigen::Index>(kN - c - 1);
    yq[row] = z[place * kN + c] / l[0] - ConstSegment(l + 1, below).dot(yq.tail(below));
  }
  if (place + 1 == factor.end()) return;
  // G^T L(k,k) = L(k+1,k), from the last column to the first.
  StateMatrix w;
  for (std::size_t c = kN; c-- > 0;) {
    const double* l = factor.column(place, c);
    StateVector sum = Eigen::Map<const StateVector>(l + (kN - c));
    for (std::size_t d = c + 1; d < kN; ++d) sum -= l[d - c] * w.col(static_cast<Eigen::Index>(d));
    w.col(static_cast<Eigen::Index>(c)) = sum;
  }
  Eigen::Map<StateMatrix>(g.data() + place * kN * kN) = w.transpose();
}

void ChainSolver::solve(std::vector<StateVector>& delta) {
  Impl& s = *impl_;
  s.forward(s.z_valid);
  delta.resize(s.factor.count());
  for (std::size_t k = s.factor.count(); k-- > 0;) {
    const std::size_t place = s.factor.begin() + k;
    delta[k] = Eigen::Map<const StateVector>(s.y.data() + place * kN);
    if (k + 1 == s.factor.count()) continue;
    const Eigen::Map<const StateMatrix> g(s.g.data() + place * kN * kN);
    for (int c = 0; c < kDim; ++c) delta[k] -= delta[k + 1][c] * g.col(c);
  }
}

void ChainSolver::eliminationOfFront(StateMatrix& information, StateVector& b) const {
  Impl& s = *impl_;
  s.forward(s.z_valid);
  const StateMatrix coupling = s.factor.couplingBlock(s.factor.begin());
  information = -(coupling * s.factor.pivots(s.factor.begin()).asDiagonal() * coupling.transpose());
  b = -(coupling * Eigen::Map<const StateVector>(s.z.data() + s.factor.begin() * kN));
}

void ChainSolver::dropFront() { impl_->factor.dropFront(); }

StateMatrix ChainSolver::newestCovariance() const {
  return impl_->factor.inverseOfBlock(impl_->factor.end() - 1);
}

// With W = L(k+1,k) L(k,k)^-1: Sigma(k) = (L D L^T)^-1 + W^T Sigma(k+1) W, and of k with k+1
// -W^T Sigma(k+1), from the end backwards; -W^T is the gain.
template <class Visitor>
void ChainSolver::Impl::recurseCovariances(std::size_t first, Visitor visit) const {
  StateMatrix sigma = StateMatrix::Zero(), with_next = StateMatrix::Zero(),
              gain = StateMatrix::Zero();
  for (std::size_t k = factor.count(); k-- > first;) {
    const std::size_t place = factor.begin() + k;
    StateMatrix next = factor.inverseOfBlock(place);
    if (k + 1 < factor.count()) {
      const StateMatrix w = factor.diagonalBlock(place)
                                .transpose()
                                .triangularView<Eigen::UnitUpper>()
                                .solve(factor.couplingBlock(place).transpose())
                                .transpose();
      gain = -w.transpose();
      with_next.noalias() = gain * sigma;
      next.noalias() -= with_next * w;
    }
    sigma = 0.5 * (next + next.transpose());
    visit(k, sigma, with_next, gain);
  }
}

std::vector<StateMatrix> ChainSolver::covariances(std::size_t first) const {
  std::vector<StateMatrix> result(impl_->factor.count() - first);
  impl_->recurseCovariances(first, [&](std::size_t k, const StateMatrix& sigma, const StateMatrix&,
                                       const StateMatrix&) { result[k - first] = sigma; });
  return result;
}

ChainSolver::JointCovariances ChainSolver::jointCovariances() const {
  const std::size_t count = impl_->factor.count();
  JointCovariances result;
  result.own.resize(count);
  result.with_next.resize(count == 0 ? 0 : count - 1);
  result.gains.resize(result.with_next.size());
  impl_->recurseCovariances(0, [&](std::size_t k, const StateMatrix& sigma,
                                   const StateMatrix& with_next, const StateMatrix& gain) {
    result.own[k] = sigma;
    if (k + 1 == count) return;
    result.with_next[k] = with_next;
    result.gains[k] = gain;
  });
  return result;
}

StateMatrix ChainSolver::covariance(std::size_t first) const {
  StateMatrix result = StateMatrix::Zero();
  impl_->recurseCovariances(first, [&](std::size_t, const StateMatrix& sigma, const StateMatrix&,
                                       const StateMatrix&) { result = sigma; });
  return result;
}

}  // namespace paloc
