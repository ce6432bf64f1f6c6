#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "paloc/core/state.h"

namespace paloc {

/// Solves the normal equations of a chain of states, H delta = b with H block-tridiagonal, and
/// keeps the factorization H = L D L^T from one call to the next: a CHOLMOD simplicial factor whose
/// rows are computed anew only from the first changed block on (cholmod_rowfac), states in order of
/// time, no fill-in. Dropping the oldest state drops its leading columns of L: what remains is the
/// factor of the Schur complement, exactly.
///
/// Blocks are numbered 0 (oldest) to size() - 1.
class PALOC_EXPORT ChainSolver {
 public:
  ChainSolver();
  ~ChainSolver();
  ChainSolver(ChainSolver&&) noexcept;
  ChainSolver& operator=(ChainSolver&&) noexcept;

  std::size_t size() const;
  void clear();

  /// Appends an empty block at the end.
  void append();
  /// Sets row block k of the lower triangle: H(k, k), H(k, k-1) (ignored for k = 0), and b(k).
  void set(std::size_t k, const StateMatrix& diagonal, const StateMatrix& off_diagonal,
           const StateVector& b);

  /// Redoes the factorization from block `first` on. Returns the number of blocks, or the index of
  /// the block where H is not positive definite (the factor is then valid before it).
  std::size_t factorizeFrom(std::size_t first);
  /// delta for all blocks, in order. Needs a valid factorization.
  void solve(std::vector<StateVector>& delta);

  /// What remains of block 0 on block 1 once it is eliminated: to be added to the part of H(1,1)
  /// and b(1) that does not come from block 0. `information` is -H10 H00^-1 H01, `b` is -H10 H00^-1
  /// b0.
  void eliminationOfFront(StateMatrix& information, StateVector& b) const;
  /// Drops block 0; the factors of the others stay valid. H(1,1) and b(1) must be set anew, to what
  /// they are with the elimination added, before they are factorized again.
  void dropFront();

  /// Covariance of the newest block: costs nothing but an 18 x 18 inverse.
  StateMatrix newestCovariance() const;
  /// Covariances of all blocks from `first` to the end, in order (Takahashi's recursion by blocks).
  std::vector<StateMatrix> covariances(std::size_t first = 0) const;
  /// Of all blocks, and of each (rows) with the one after it (columns): one less. `gains` tell how
  /// a block follows the one after it: P(k, l) = gains[k] P(k+1, l) for every l > k.
  struct JointCovariances {
    std::vector<StateMatrix> own, with_next, gains;
  };
  JointCovariances jointCovariances() const;
  /// Covariance of block `first` alone, by the same recursion.
  StateMatrix covariance(std::size_t first) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace paloc
