#pragma once

#include <vector>

#include "paloc/core/chain.h"

namespace paloc {

/// How a state q between two nodes a and b depends on their errors, to first order:
/// delta_q = from_before delta_a + from_after delta_b + w, w ~ N(0, own).
struct StateBetween {
  StateMatrix from_before = StateMatrix::Zero();
  StateMatrix from_after = StateMatrix::Zero();
  StateMatrix own = StateMatrix::Zero();

  /// The covariance of q where that of [a; b] is [cov_a, cov_ab; cov_ab^T, cov_b].
  PALOC_EXPORT StateMatrix covariance(const StateMatrix& cov_a, const StateMatrix& cov_ab,
                                      const StateMatrix& cov_b) const;
};

/// Conditions q on its neighbours, given the factors on either side of it. Let these have the
/// Hessian blocks H_qa, H_qq (of both sides together) and H_qb at the states given. Then
///
///   own = H_qq^-1,   from_before = -H_qq^-1 H_qa,   from_after = -H_qq^-1 H_qb.
///
/// The factor that joined a and b in the smoother is what both sides sum up to, so that with the
/// smoother's joint covariance of a and b this is the covariance that a node at q would have had.
/// The factors must hold all of q. At a node itself one side's information is without bounds: q
/// should be at least a millisecond away from both.
PALOC_EXPORT StateBetween conditionOnNeighbours(const State& a,
                                                const std::vector<EdgeFactor>& from_a_to_q,
                                                const State& q,
                                                const std::vector<EdgeFactor>& from_q_to_b,
                                                const State& b);

}  // namespace paloc
