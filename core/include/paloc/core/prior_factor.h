#pragma once

#include "paloc/core/linearization.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// A prior on the whole state of one node, in information form: what is known at the start, and
/// what marginalization leaves of older nodes. Its linearization point stays frozen.
///
///   cost(x) = d^T Lambda d - 2 eta^T d,    d = x boxminus x_0      (18)
///
/// Not a sum of squares of its own: marginalization leaves Lambda and eta, and Lambda may be
/// singular.
class PALOC_EXPORT PriorFactor {
 public:
  /// A prior that expects `mean` with the standard deviations `sigma` (18, tangent of State); an
  /// infinite one leaves its direction free.
  static PriorFactor fromSigmas(const State& mean, const StateVector& sigma);

  PriorFactor(const State& linearization_point, const StateMatrix& information,
              const StateVector& information_vector);

  /// Adds its share at `x` to the normal equations H delta = b, and returns its cost there.
  double addTo(const State& x, StateMatrix& hessian, StateVector& b) const;

  const StateMatrix& information() const { return information_; }

 private:
  State linearization_point_;
  StateMatrix information_;
  StateVector information_vector_;
};

}  // namespace paloc
