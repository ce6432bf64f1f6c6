#include "chain_cholesky.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <vector>

namespace paloc {
namespace {

using tangent::kDim;

constexpr std::size_t kN = ChainCholesky::kN;
constexpr std::size_t kFirstCapacity = 64;
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

ChainCholesky::ChainCholesky() {
  cholmod_start(&common_);
  common_.print = 0;
  // Also for the batch: with no fill beyond two blocks a column, supernodes save no work. 20,000
  // blocks of 15 take 0.10 s like this and 0.53 s supernodal with Debian's libblas3.
  common_.supernodal = CHOLMOD_SIMPLICIAL;
  common_.grow2 = 0;  // columns have their final length from the start
  allocate(kFirstCapacity);
}

ChainCholesky::~ChainCholesky() {
  release();
  cholmod_finish(&common_);
}

void ChainCholesky::release() {
  cholmod_free_factor(&L_, &common_);
  cholmod_free_sparse(&A_, &common_);
}

void ChainCholesky::allocate(std::size_t blocks) {
  const std::size_t n = (blocks + 1) * kN;  // one block more, so that every column has full length
  L_ = cholmod_allocate_factor(n, &common_);
  A_ = cholmod_allocate_sparse(n, n, (blocks + 1) * kBlockEntries, 1, 0, 1, CHOLMOD_REAL, &common_);
  if (!L_ || !A_) throw std::bad_alloc();
  int* column_count = static_cast<int*>(L_->ColCount);
  for (std::size_t j = 0; j < n; ++j) {
    column_count[j] = static_cast<int>(std::min(columnEntries(j % kN), n - j));
  }
  if (!cholmod_change_factor(CHOLMOD_REAL, 0, 0, 0, 1, L_, &common_)) throw std::bad_alloc();
  capacity_ = blocks;
  setPatternOfL();
  setPatternOfA();
}

void ChainCholesky::setPatternOfL() const {
  const int* p = static_cast<const int*>(L_->p);
  int* row = static_cast<int*>(L_->i);
  for (std::size_t j = 0; j < capacity_ * kN; ++j) {
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

void ChainCholesky::setPatternOfA() {
  int* p = static_cast<int*>(A_->p);
  int* row = static_cast<int*>(A_->i);
  int* entries = static_cast<int*>(A_->nz);
  double* value = ax();
  std::fill(value, value + A_->nzmax, 0.0);
  for (std::size_t j = 0; j < A_->ncol; ++j) {
    const std::size_t place = j / kN, c = j % kN;
    const std::size_t start = place * kBlockEntries + upperColumnStart(c);
    p[j] = static_cast<int>(start);
    entries[j] = static_cast<int>(kN + c + 1);
    // The first place has no block above it: it is always the window's oldest, and never asked.
    const std::size_t first_row = place == 0 ? 0 : (place - 1) * kN;
    for (std::size_t e = 0; e < kN; ++e) row[start + e] = static_cast<int>(first_row + e);
    for (std::size_t e = 0; e <= c; ++e) row[start + kN + e] = static_cast<int>(place * kN + e);
  }
  p[A_->ncol] = static_cast<int>(A_->nzmax);
}

void ChainCholesky::grow(std::size_t blocks) {
  const auto window = [this](double* values) {
    return std::vector<double>(values + begin_ * kBlockEntries, values + end() * kBlockEntries);
  };
  const std::vector<double> lx_old = window(lx()), ax_old = window(ax());
  release();
  allocate(blocks);
  std::copy(lx_old.begin(), lx_old.end(), lx());
  std::copy(ax_old.begin(), ax_old.end(), ax());
  begin_ = 0;
}

void ChainCholesky::append() {
  if (end() == capacity_) {
    // Moving costs as much as several updates: with room for four windows, one update in three
    // windows pays for it.
    if (count_ * 4 > capacity_) {
      grow(capacity_ * 2);
    } else {
      for (double* values : {lx(), ax()}) {
        std::copy(values + begin_ * kBlockEntries, values + end() * kBlockEntries, values);
      }
      begin_ = 0;
    }
  }
  ++count_;
}

void ChainCholesky::set(std::size_t place, const StateMatrix& diagonal,
                        const StateMatrix& off_diagonal) {
  for (std::size_t c = 0; c < kN; ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    double* values = ax() + place * kBlockEntries + upperColumnStart(c);
    // Column c of the upper triangle is row c of the lower one.
    Segment(values, kDim) = off_diagonal.row(row).transpose();
    Segment(values + kN, row + 1) = diagonal.row(row).head(row + 1).transpose();
  }
}

// Brings the lengths of the columns in line with the window: rows and columns from `place` on
// become those of the identity, as cholmod_rowfac wants them, and H's oldest block has none above
// it.
void ChainCholesky::cutBefore(std::size_t place) {
  int* l_entries = static_cast<int*>(L_->nz);
  int* a_start = static_cast<int*>(A_->p);
  int* a_entries = static_cast<int*>(A_->nz);
  for (std::size_t q = begin_; q < end(); ++q) {
    const std::size_t skip = q == begin_ ? kN : 0;
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

bool ChainCholesky::pivotsPositive(std::size_t place) const {
  for (std::size_t c = 0; c < kN; ++c) {
    const double d = column(place, c)[0];
    if (!(d > 0) || !std::isfinite(d)) return false;
  }
  return true;
}

std::size_t ChainCholesky::factorizeFrom(std::size_t place) {
  cutBefore(place);
  double beta[2] = {0, 0};
  if (!cholmod_rowfac(A_, nullptr, beta, place * kN, end() * kN, L_, &common_) &&
      common_.status < CHOLMOD_OK) {
    throw std::bad_alloc();
  }
  L_->minor = L_->n;
  for (std::size_t q = place; q < end(); ++q) {
    if (!pivotsPositive(q)) return q;
  }
  return end();
}

const double* ChainCholesky::column(std::size_t place, std::size_t c) const {
  return static_cast<const double*>(L_->x) + place * kBlockEntries + columnStart(c);
}

StateMatrix ChainCholesky::diagonalBlock(std::size_t place) const {
  StateMatrix l = StateMatrix::Identity();
  for (std::size_t c = 0; c + 1 < kN; ++c) {
    const auto below = static_cast<Eigen::Index>(kN - c - 1);
    l.col(static_cast<Eigen::Index>(c)).tail(below) = ConstSegment(column(place, c) + 1, below);
  }
  return l;
}

StateVector ChainCholesky::pivots(std::size_t place) const {
  StateVector d;
  for (std::size_t c = 0; c < kN; ++c) d[static_cast<Eigen::Index>(c)] = column(place, c)[0];
  return d;
}

StateMatrix ChainCholesky::couplingBlock(std::size_t place) const {
  StateMatrix l;
  for (std::size_t c = 0; c < kN; ++c) {
    l.col(static_cast<Eigen::Index>(c)) = ConstSegment(column(place, c) + (kN - c), kDim);
  }
  return l;
}

StateMatrix ChainCholesky::inverseOfBlock(std::size_t place) const {
  const StateMatrix l_inverse =
      diagonalBlock(place).triangularView<Eigen::UnitLower>().solve(StateMatrix::Identity());
  return l_inverse.transpose() * pivots(place).cwiseInverse().asDiagonal() * l_inverse;
}

}  // namespace paloc
