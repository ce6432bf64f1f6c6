#pragma once

#include <vector>

#include "paloc/core/chain.h"
#include "paloc/core/smoother_settings.h"

namespace paloc {

/// What became of a batch optimization.
struct BatchSummary {
  enum class Status { kConverged, kIterationLimit, kFailed };
  Status status = Status::kFailed;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;  ///< robust, whitened; 1
  std::vector<StateMatrix> covariances;     ///< of every node, at the solution
  /// Of every node (rows) with the one after it (columns): one less.
  std::vector<StateMatrix> covariances_with_next;
  std::vector<StateMatrix> gains;  ///< see ChainSolver::JointCovariances
};

/// Smooths a whole recording at once: Levenberg-Marquardt (Marquardt's scaling) over all nodes,
/// with the marginal covariance of every node. The states of `nodes` are the first guess and become
/// the result; on failure they are the best found.
///
/// It solves with ChainSolver too: on a chain without fill-in a simplicial factorization is linear
/// in the number of nodes (7 us each), and dense supernodes have nothing to gain.
PALOC_EXPORT BatchSummary smoothBatch(std::vector<ChainNode>& nodes,
                                      const SmootherSettings& settings);

}  // namespace paloc
