#include "paloc/core/state_between.h"

#include <Eigen/Cholesky>

namespace paloc {

StateMatrix StateBetween::covariance(const StateMatrix& cov_a, const StateMatrix& cov_ab,
                                     const StateMatrix& cov_b) const {
  const StateMatrix crossed = from_before * cov_ab * from_after.transpose();
  const StateMatrix sum = own + from_before * cov_a * from_before.transpose() + crossed +
                          crossed.transpose() + from_after * cov_b * from_after.transpose();
  return 0.5 * (sum + sum.transpose());
}

StateBetween conditionOnNeighbours(const State& a, const std::vector<EdgeFactor>& from_a_to_q,
                                   const State& q, const std::vector<EdgeFactor>& from_q_to_b,
                                   const State& b) {
  ChainNode before, middle, after;
  before.state = a;
  middle.state = q;
  middle.edge_factors = from_a_to_q;
  after.state = b;
  after.edge_factors = from_q_to_b;
  const ChainBlock first = linearizeEdge(before, middle), second = linearizeEdge(middle, after);
  const StateMatrix hessian = first.hessian_jj + second.hessian_ii;
  // Units from metres to bias walks span many orders: scaled, the inverse keeps its digits.
  const StateVector scale = hessian.diagonal().cwiseSqrt().cwiseInverse();
  const StateMatrix scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  const Eigen::LLT<StateMatrix> llt(scaled);
  StateBetween result;
  const auto solve = [&](const StateMatrix& right) -> StateMatrix {
    return scale.asDiagonal() * llt.solve(StateMatrix(scale.asDiagonal() * right));
  };
  result.own = solve(StateMatrix::Identity());
  result.from_before = -solve(first.hessian_ji);
  result.from_after = -solve(second.hessian_ji.transpose());
  return result;
}

}  // namespace paloc
