#pragma once

#include <cholmod.h>

#include <cstddef>

#include "paloc/core/state.h"

namespace paloc {

/// The block-tridiagonal matrix H of a chain and its CHOLMOD factor L D L^T, in arrays with room
/// for more blocks than the window has. A block's place in the arrays is its number in the window
/// plus begin(); the pattern is the same at every place, so that dropping the oldest block moves
/// only begin().
class ChainCholesky {
 public:
  static constexpr std::size_t kN = tangent::kDim;

  ChainCholesky();
  ~ChainCholesky();
  ChainCholesky(const ChainCholesky&) = delete;
  ChainCholesky& operator=(const ChainCholesky&) = delete;

  std::size_t begin() const { return begin_; }
  std::size_t end() const { return begin_ + count_; }
  std::size_t count() const { return count_; }
  std::size_t capacity() const { return capacity_; }

  void clear() { begin_ = count_ = 0; }
  /// Appends a block. The window moves to the front of the arrays, or into larger ones, when their
  /// end is reached: then begin() is 0 afterwards, whatever it was.
  void append();
  void dropFront() { ++begin_, --count_; }

  /// Row block of H at a place: H(k, k), and H(k, k-1), ignored at begin().
  void set(std::size_t place, const StateMatrix& diagonal, const StateMatrix& off_diagonal);
  /// Computes the rows of L from `place` on (cholmod_rowfac). Returns end(), or the place where H
  /// is not positive definite.
  std::size_t factorizeFrom(std::size_t place);

  /// Column c of L at a place, from its diagonal entry on, which holds D.
  const double* column(std::size_t place, std::size_t c) const;
  StateMatrix diagonalBlock(std::size_t place) const;   ///< L(k, k), unit lower triangular
  StateVector pivots(std::size_t place) const;          ///< D(k)
  StateMatrix couplingBlock(std::size_t place) const;   ///< L(k+1, k)
  StateMatrix inverseOfBlock(std::size_t place) const;  ///< (L(k,k) D(k) L(k,k)^T)^-1

 private:
  // NOLINTBEGIN(readability-make-member-function-const): they hand out what is to be changed
  double* lx() { return static_cast<double*>(L_->x); }
  double* ax() { return static_cast<double*>(A_->x); }
  // NOLINTEND(readability-make-member-function-const)

  void release();
  void allocate(std::size_t blocks);
  void grow(std::size_t blocks);
  void setPatternOfL() const;
  void setPatternOfA();
  void cutBefore(std::size_t place);
  bool pivotsPositive(std::size_t place) const;

  cholmod_common common_{};
  cholmod_factor* L_ = nullptr;
  cholmod_sparse* A_ = nullptr;
  std::size_t capacity_ = 0;
  std::size_t begin_ = 0;
  std::size_t count_ = 0;
};

}  // namespace paloc
