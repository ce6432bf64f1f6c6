#include "paloc/core/chain_solver.h"

#include <cholmod.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

namespace paloc {
namespace {

using tangent::kDim;

constexpr std::size_t kN = kDim;
// Entries of one block's columns of L: the lower triangle, and all rows of the next block. The
// upper triangle of H by columns has as many.
constexpr std::size_t kBlockEntries = kN * (kN + 1) / 2 + kN * kN;

// Where column c of a block starts among the block's entries of L.
constexpr std::size_t columnStart(std::size_t c) { return c * 2 * kN - c * (c - 1) / 2; }
constexpr std::size_t columnEntries(std::size_t c) { return 2 * kN - c; }
// Likewise of H: all rows of the block before, then the upper triangle.
constexpr std::size_t upperColumnStart(std::size_t c) { return c * kN + c * (c + 1) / 2; }

using Segment = Eigen::Map<Eigen::VectorXd>;
using ConstSegment = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

struct ChainSolver::Impl {
  cholmod_common common{};
  cholmod_factor* L = nullptr;
  cholmod_sparse* A = nullptr;
  std::size_t capacity = 0;  // blocks that L and A have room for
  std::size_t begin = 0;  // the oldest block's place among them: dropping a block only moves this
  std::size_t count = 0;
  std::vector<double> b;  // right-hand side, by place
  // Kept from one solution to the next, for places before z_valid: L z = b, and with them
  //   delta(k) = y(k) - G(k) delta(k+1),  y = L(k,k)^-T D^-1 z,  G = (L(k+1,k) L(k,k)^-1)^T,
  // so that back-substitution is one product a block.
  std::vector<double> z, y, g;
  std::size_t z_valid = 0;

  Impl() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.grow2 = 0;  // columns have their final length from the start
    reserve(64);
  }
  ~Impl() {
    release();
    cholmod_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  // NOLINTBEGIN(readability-make-member-function-const): they hand out what is to be changed
  double* lx() { return static_cast<double*>(L->x); }
  double* ax() { return static_cast<double*>(A->x); }
  // NOLINTEND(readability-make-member-function-const)
  const double* lx() const { return static_cast<const double*>(L->x); }
  const double* column(std::size_t place, std::size_t c) const {
    return lx() + place * kBlockEntries + columnStart(c);
  }

  void release() {
    cholmod_free_factor(&L, &common);
    cholmod_free_sparse(&A, &common);
  }
  void reserve(std::size_t blocks);
  void allocate(std::size_t blocks);
  void setPatternOfL() const;
  void setPatternOfA();
  void makeRoom();
  void cutBefore(std::size_t place);
  bool pivotsPositive(std::size_t place) const;
  void forward(std::size_t place);
  void prepareBackward(std::size_t place);
  StateMatrix factorOfBlock(std::size_t place) const;    // L(k, k), unit lower triangular
  StateVector pivotsOfBlock(std::size_t place) const;    // D(k)
  StateMatrix couplingOfBlock(std::size_t place) const;  // L(k+1, k)
  StateMatrix inverseOfBlock(std::size_t place) const;   // (L(k,k) D(k) L(k,k)^T)^-1
  template <class Visitor>
  void recurseCovariances(std::size_t first, Visitor visit) const;
};

void ChainSolver::Impl::allocate(std::size_t blocks) {
  const std::size_t n = (blocks + 1) * kN;  // one block more, so that every column has full length
  L = cholmod_allocate_factor(n, &common);
  A = cholmod_allocate_sparse(n, n, (blocks + 1) * kBlockEntries, 1, 0, 1, CHOLMOD_REAL, &common);
  if (!L || !A) throw std::bad_alloc();
  int* column_count = static_cast<int*>(L->ColCount);
  for (std::size_t j = 0; j < n; ++j) {
    column_count[j] = static_cast<int>(std::min(columnEntries(j % kN), n - j));
  }
  if (!cholmod_change_factor(CHOLMOD_REAL, 0, 0, 0, 1, L, &common)) throw std::bad_alloc();
  capacity = blocks;
  b.assign(n, 0);
  z.assign(n, 0);
  y.assign(n, 0);
  g.assign(n * kN, 0);
  setPatternOfL();
  setPatternOfA();
}

void ChainSolver::Impl::setPatternOfL() const {
  const int* p = static_cast<const int*>(L->p);
  int* row = static_cast<int*>(L->i);
  for (std::size_t j = 0; j < capacity * kN; ++j) {
    const std::size_t place = j / kN, c = j % kN;
    // CHOLMOD lays the columns out one after the other; everything here relies on it.
    if (static_cast<std::size_t>(p[j]) != place * kBlockEntries + columnStart(c)) {
      throw std::logic_error("unexpected column layout of the CHOLMOD factor");
    }
    for (std::size_t e = 0; e < columnEntries(c); ++e) {
      row[static_cast<std::size_t>(p[j]) + e] = static_cast<int>(j + e);
    }
  }
}

void ChainSolver::Impl::setPatternOfA() {
  int* p = static_cast<int*>(A->p);
  int* row = static_cast<int*>(A->i);
  int* entries = static_cast<int*>(A->nz);
  double* value = ax();
  std::fill(value, value + A->nzmax, 0.0);
  for (std::size_t j = 0; j < A->ncol; ++j) {
    const std::size_t place = j / kN, c = j % kN;
    const std::size_t start = place * kBlockEntries + upperColumnStart(c);
    p[j] = static_cast<int>(start);
    entries[j] = static_cast<int>(kN + c + 1);
    // The first place has no block above it: it is always the window's oldest, and never asked.
    const std::size_t first_row = place == 0 ? 0 : (place - 1) * kN;
    for (std::size_t e = 0; e < kN; ++e) row[start + e] = static_cast<int>(first_row + e);
    for (std::size_t e = 0; e <= c; ++e) row[start + kN + e] = static_cast<int>(place * kN + e);
  }
  p[A->ncol] = static_cast<int>(A->nzmax);
}

void ChainSolver::Impl::reserve(std::size_t blocks) {
  if (blocks <= capacity) return;
  std::vector<double> lx_old, ax_old;
  if (L) {
    lx_old.assign(lx() + begin * kBlockEntries, lx() + (begin + count) * kBlockEntries);
    ax_old.assign(ax() + begin * kBlockEntries, ax() + (begin + count) * kBlockEntries);
  }
  const std::vector<double> b_old = b, z_old = z, y_old = y, g_old = g;
  const std::size_t begin_old = begin;
  release();
  allocate(blocks);
  std::copy(lx_old.begin(), lx_old.end(), lx());
  std::copy(ax_old.begin(), ax_old.end(), ax());
  for (std::size_t k = 0; k < count * kN; ++k) {
    b[k] = b_old[begin_old * kN + k];
    z[k] = z_old[begin_old * kN + k];
    y[k] = y_old[begin_old * kN + k];
  }
  if (!g_old.empty()) {
    std::copy_n(g_old.begin() + static_cast<std::ptrdiff_t>(begin_old * kN * kN), count * kN * kN,
                g.begin());
  }
  begin = 0;
  z_valid -= std::min(z_valid, begin_old);
}

// Makes place for one more block: moves the window to the front of the arrays when its end is
// reached. The pattern is the same at every place, so only values move.
void ChainSolver::Impl::makeRoom() {
  if (begin + count < capacity) return;
  // Moving costs as much as several updates: with room for four windows, one update in three
  // windows pays for it.
  if (count * 4 > capacity) {
    reserve(capacity * 2);
    return;
  }
  const auto shift = [&](double* values, std::size_t entries) {
    std::copy(values + begin * entries, values + (begin + count) * entries, values);
  };
  shift(lx(), kBlockEntries);
  shift(ax(), kBlockEntries);
  shift(b.data(), kN);
  shift(z.data(), kN);
  shift(y.data(), kN);
  shift(g.data(), kN * kN);
  z_valid -= std::min(z_valid, begin);
  begin = 0;
}

// Brings the lengths of the columns in line with the window: rows and columns from `place` on
// become those of the identity, as cholmod_rowfac wants them, and H's oldest block has none above
// it.
void ChainSolver::Impl::cutBefore(std::size_t place) {
  int* l_entries = static_cast<int*>(L->nz);
  int* a_start = static_cast<int*>(A->p);
  int* a_entries = static_cast<int*>(A->nz);
  for (std::size_t q = begin; q < begin + count; ++q) {
    const std::size_t skip = q == begin ? kN : 0;
    for (std::size_t c = 0; c < kN; ++c) {
      const std::size_t j = q * kN + c;
      const std::size_t kept = q >= place ? 1 : (q + 1 == place ? kN : 2 * kN) - c;
      l_entries[j] = static_cast<int>(kept);
      if (q >= place) lx()[q * kBlockEntries + columnStart(c)] = 1.0;
      a_start[j] = static_cast<int>(q * kBlockEntries + upperColumnStart(c) + skip);
      a_entries[j] = static_cast<int>(kN - skip + c + 1);
    }
  }
}

bool ChainSolver::Impl::pivotsPositive(std::size_t place) const {
  for (std::size_t c = 0; c < kN; ++c) {
    const double d = column(place, c)[0];
    if (!(d > 0) || !std::isfinite(d)) return false;
  }
  return true;
}

ChainSolver::ChainSolver() : impl_(std::make_unique<Impl>()) {}
ChainSolver::~ChainSolver() = default;
ChainSolver::ChainSolver(ChainSolver&&) noexcept = default;
ChainSolver& ChainSolver::operator=(ChainSolver&&) noexcept = default;

std::size_t ChainSolver::size() const { return impl_->count; }

void ChainSolver::clear() {
  impl_->begin = 0;
  impl_->count = 0;
  impl_->z_valid = 0;
}

void ChainSolver::append() {
  impl_->makeRoom();
  ++impl_->count;
}

void ChainSolver::set(std::size_t k, const StateMatrix& diagonal, const StateMatrix& off_diagonal,
                      const StateVector& b) {
  Impl& s = *impl_;
  const std::size_t place = s.begin + k;
  for (std::size_t c = 0; c < kN; ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    double* values = s.ax() + place * kBlockEntries + upperColumnStart(c);
    // Column c of the upper triangle is row c of the lower one.
    Segment(values, kDim) = off_diagonal.row(row).transpose();
    Segment(values + kN, row + 1) = diagonal.row(row).head(row + 1).transpose();
    s.b[place * kN + c] = b[row];
  }
}

std::size_t ChainSolver::factorizeFrom(std::size_t first) {
  Impl& s = *impl_;
  const std::size_t place = s.begin + first, end = s.begin + s.count;
  s.cutBefore(place);
  s.z_valid = std::min(s.z_valid, place);
  double beta[2] = {0, 0};
  if (!cholmod_rowfac(s.A, nullptr, beta, place * kN, end * kN, s.L, &s.common) &&
      s.common.status < CHOLMOD_OK) {
    throw std::bad_alloc();
  }
  s.L->minor = s.L->n;
  for (std::size_t q = place; q < end; ++q) {
    if (!s.pivotsPositive(q)) return q - s.begin;
  }
  return s.count;
}

// L z = b from `place` on, and what back-substitution needs of it.
void ChainSolver::Impl::forward(std::size_t place) {
  const std::size_t end = begin + count;
  if (place >= end) return;
  for (std::size_t q = std::max(place, begin); q < end; ++q) {
    Eigen::Map<StateVector> zq(z.data() + q * kN);
    zq = Eigen::Map<const StateVector>(b.data() + q * kN);
    if (q > begin) {
      for (std::size_t c = 0; c < kN; ++c) {
        zq -= z[(q - 1) * kN + c] * Eigen::Map<const StateVector>(column(q - 1, c) + (kN - c));
      }
    }
    for (std::size_t c = 0; c + 1 < kN; ++c) {
      const auto below = static_cast<Eigen::Index>(kN - c - 1);
      zq.tail(below) -= zq[static_cast<Eigen::Index>(c)] * ConstSegment(column(q, c) + 1, below);
    }
  }
  // The block before the first new row is coupled to it.
  for (std::size_t q = std::max(place, begin + 1) - 1; q < end; ++q) prepareBackward(q);
  z_valid = end;
}

void ChainSolver::Impl::prepareBackward(std::size_t place) {
  Eigen::Map<StateVector> yq(y.data() + place * kN);
  for (std::size_t c = kN; c-- > 0;) {
    const double* l = column(place, c);
    const auto row = static_cast<Eigen::Index>(c), below = static_cast<Eigen::Index>(kN - c - 1);
    yq[row] = z[place * kN + c] / l[0] - ConstSegment(l + 1, below).dot(yq.tail(below));
  }
  if (place + 1 == begin + count) return;
  // G^T L(k,k) = L(k+1,k), from the last column to the first.
  StateMatrix w;
  for (std::size_t c = kN; c-- > 0;) {
    const double* l = column(place, c);
    StateVector sum = Eigen::Map<const StateVector>(l + (kN - c));
    for (std::size_t d = c + 1; d < kN; ++d) sum -= l[d - c] * w.col(static_cast<Eigen::Index>(d));
    w.col(static_cast<Eigen::Index>(c)) = sum;
  }
  Eigen::Map<StateMatrix>(g.data() + place * kN * kN) = w.transpose();
}

void ChainSolver::solve(std::vector<StateVector>& delta) {
  Impl& s = *impl_;
  s.forward(s.z_valid);
  delta.resize(s.count);
  for (std::size_t k = s.count; k-- > 0;) {
    const std::size_t place = s.begin + k;
    delta[k] = Eigen::Map<const StateVector>(s.y.data() + place * kN);
    if (k + 1 == s.count) continue;
    const Eigen::Map<const StateMatrix> g(s.g.data() + place * kN * kN);
    for (int c = 0; c < kDim; ++c) delta[k] -= delta[k + 1][c] * g.col(c);
  }
}

StateMatrix ChainSolver::Impl::factorOfBlock(std::size_t place) const {
  StateMatrix l = StateMatrix::Identity();
  for (std::size_t c = 0; c + 1 < kN; ++c) {
    const auto below = static_cast<Eigen::Index>(kN - c - 1);
    l.col(static_cast<Eigen::Index>(c)).tail(below) = ConstSegment(column(place, c) + 1, below);
  }
  return l;
}

StateVector ChainSolver::Impl::pivotsOfBlock(std::size_t place) const {
  StateVector d;
  for (std::size_t c = 0; c < kN; ++c) d[static_cast<Eigen::Index>(c)] = column(place, c)[0];
  return d;
}

StateMatrix ChainSolver::Impl::couplingOfBlock(std::size_t place) const {
  StateMatrix l;
  for (std::size_t c = 0; c < kN; ++c) {
    l.col(static_cast<Eigen::Index>(c)) = ConstSegment(column(place, c) + (kN - c), kDim);
  }
  return l;
}

StateMatrix ChainSolver::Impl::inverseOfBlock(std::size_t place) const {
  const StateMatrix l_inverse =
      factorOfBlock(place).triangularView<Eigen::UnitLower>().solve(StateMatrix::Identity());
  return l_inverse.transpose() * pivotsOfBlock(place).cwiseInverse().asDiagonal() * l_inverse;
}

void ChainSolver::eliminationOfFront(StateMatrix& information, StateVector& b) const {
  Impl& s = *impl_;
  s.forward(s.z_valid);
  const StateMatrix coupling = s.couplingOfBlock(s.begin);
  information = -(coupling * s.pivotsOfBlock(s.begin).asDiagonal() * coupling.transpose());
  b = -(coupling * Eigen::Map<const StateVector>(s.z.data() + s.begin * kN));
}

void ChainSolver::dropFront() {
  ++impl_->begin;
  --impl_->count;
}

StateMatrix ChainSolver::newestCovariance() const {
  return impl_->inverseOfBlock(impl_->begin + impl_->count - 1);
}

// With W = L(k+1,k) L(k,k)^-1: Sigma(k) = (L D L^T)^-1 + W^T Sigma(k+1) W, from the end backwards.
template <class Visitor>
void ChainSolver::Impl::recurseCovariances(std::size_t first, Visitor visit) const {
  StateMatrix sigma = StateMatrix::Zero();
  for (std::size_t k = count; k-- > first;) {
    const std::size_t place = begin + k;
    StateMatrix next = inverseOfBlock(place);
    if (k + 1 < count) {
      const StateMatrix w = factorOfBlock(place)
                                .transpose()
                                .triangularView<Eigen::UnitUpper>()
                                .solve(couplingOfBlock(place).transpose())
                                .transpose();
      next.noalias() += w.transpose() * sigma * w;
    }
    sigma = 0.5 * (next + next.transpose());
    visit(k, sigma);
  }
}

std::vector<StateMatrix> ChainSolver::covariances(std::size_t first) const {
  std::vector<StateMatrix> result(impl_->count - first);
  impl_->recurseCovariances(
      first, [&](std::size_t k, const StateMatrix& sigma) { result[k - first] = sigma; });
  return result;
}

StateMatrix ChainSolver::covariance(std::size_t first) const {
  StateMatrix result = StateMatrix::Zero();
  impl_->recurseCovariances(first, [&](std::size_t, const StateMatrix& sigma) { result = sigma; });
  return result;
}

}  // namespace paloc
