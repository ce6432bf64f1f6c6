#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "paloc/core/chain_solver.h"
#include "paloc/core/export.h"

namespace paloc {

// The covariance of a chain's estimate when the errors of its factors are not what its weights
// take them for. With weights that give the information A and P = A^-1, gradients that have the
// covariance A - D + sum_j U_j U_j^T give the estimate
//
//   P - P D P + sum_j (P U_j) (P U_j)^T.
//
// D is block-diagonal: what the weights have for errors, each node's independent of the others',
// that are constant errors in truth. U_j: by what one standard deviation of the j-th of these
// changes the gradients of all nodes. (The "consider" covariance of shared_errors.h, over time.)

/// What one standard deviation of an error adds to the gradient of a node's pose.
struct NodeGradient {
  std::size_t node = 0;
  Vec6 gradient = Vec6::Zero();  ///< units of information times [m, rad]
};

/// An error that stays the same over a recording, by the nodes that it acts on, ascending.
using ConstantError = std::vector<NodeGradient>;

/// Replaces `own` and `with_next` of A^-1 by those of the covariance above. `taken_as_white` is D,
/// the pose's part of each node. Effects below 1e-4 of a variance are left out, so that an error
/// costs little where it has not acted for long.
PALOC_EXPORT void considerConstantErrors(std::span<const Mat6> taken_as_white,
                                         std::span<const ConstantError> errors,
                                         ChainSolver::JointCovariances& covariances);

}  // namespace paloc
