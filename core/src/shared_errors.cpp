#include "paloc/core/shared_errors.h"

#include <Eigen/Cholesky>

namespace paloc {
namespace {

using Square = Eigen::Matrix<double, 6, 6>;

Eigen::LDLT<Square> factorOfSum(const Mat6& independent, const Mat6& spread) {
  Square sum = independent + spread;
  // What is not known is zero in both; the ridge only keeps the solve from dividing zero by zero.
  sum += 1e-12 * sum.diagonal().maxCoeff() * Square::Identity();
  return sum.ldlt();
}

}  // namespace

Mat6 informationUnderSharedErrors(const Mat6& independent, const Mat6& spread) {
  const Square own = independent;
  const Square information = own * factorOfSum(independent, spread).solve(own);
  return 0.5 * (information + information.transpose());
}

Mat6 gainUnderSharedErrors(const Mat6& independent, const Mat6& spread) {
  const Square own = independent;
  return factorOfSum(independent, spread).solve(own).transpose();
}

}  // namespace paloc
