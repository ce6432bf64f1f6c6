#include "paloc/core/shared_errors.h"

#include <Eigen/Cholesky>

namespace paloc {

Mat6 informationUnderSharedErrors(const Mat6& independent, const Mat6& spread) {
  using Square = Eigen::Matrix<double, 6, 6>;
  const Square own = independent;
  Square sum = independent + spread;
  // What is not known is zero in both; the ridge only keeps the solve from dividing zero by zero.
  sum += 1e-12 * sum.diagonal().maxCoeff() * Square::Identity();
  const Square information = own * sum.ldlt().solve(own);
  return 0.5 * (information + information.transpose());
}

}  // namespace paloc
