#include "paloc/core/prior_factor.h"

#include <cmath>

namespace paloc {

PriorFactor PriorFactor::fromSigmas(const State& mean, const StateVector& sigma) {
  StateVector information;
  for (int k = 0; k < tangent::kDim; ++k) {
    information[k] = std::isinf(sigma[k]) ? 0.0 : 1 / (sigma[k] * sigma[k]);
  }
  return PriorFactor(mean, information.asDiagonal(), StateVector::Zero());
}

PriorFactor::PriorFactor(const State& linearization_point, const StateMatrix& information,
                         const StateVector& information_vector)
    : linearization_point_(linearization_point),
      information_(0.5 * (information + information.transpose())),
      information_vector_(information_vector) {}

double PriorFactor::addTo(const State& x, StateMatrix& hessian, StateVector& b) const {
  // With x moved by delta, d becomes d0 + J delta; J is the identity but for the rotation.
  const StateVector d0 = boxminus(x, linearization_point_);
  const StateVector gradient = information_vector_ - information_ * d0;
  const Mat3 jr_inverse = so3::rightJacobianInverse(d0.segment<3>(tangent::kRotation));
  StateMatrix hj = information_;  // Lambda J
  hj.middleCols<3>(tangent::kRotation) =
      (information_.middleCols<3>(tangent::kRotation) * jr_inverse).eval();
  StateMatrix jhj = hj;  // J^T Lambda J
  jhj.middleRows<3>(tangent::kRotation) =
      (jr_inverse.transpose() * hj.middleRows<3>(tangent::kRotation)).eval();
  hessian += jhj;
  StateVector j_gradient = gradient;
  j_gradient.segment<3>(tangent::kRotation) =
      jr_inverse.transpose() * gradient.segment<3>(tangent::kRotation);
  b += j_gradient;
  return d0.dot(information_ * d0) - 2 * information_vector_.dot(d0);
}

}  // namespace paloc
