#include "alignment_step.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace paloc {
namespace {

constexpr double kLongestStepM = 0.5, kLongestStepRad = 0.2;
constexpr double kAnchorSigma = 1e-4;  // m or rad: holds a free direction at the start

}  // namespace

void Anchors::hold(const std::array<MatchDirection, 6>& directions) {
  axes_.clear();
  for (std::size_t i = 0; i < 6; ++i) {
    const MatchDirection& direction = directions[i];
    if (direction.cls != DirectionClass::kNone) continue;
    Vec6 axis = Vec6::Zero();
    axis.segment<3>(i < 3 ? 0 : 3) = direction.axis_body;
    axes_.push_back(axis);
  }
}

void Anchors::addTo(NormalEquations& equations, const Vec6& from_start) const {
  const double weight = 1 / (kAnchorSigma * kAnchorSigma);
  for (const Vec6& axis : axes_) {
    equations.information += weight * axis * axis.transpose();
    equations.gradient += (weight * axis.dot(from_start)) * axis;
  }
}

bool solveStep(const NormalEquations& equations, Vec6& step) {
  using Matrix = Eigen::Matrix<double, 6, 6>;
  const Matrix information = equations.information;
  const double floor = 1e-9 * information.diagonal().maxCoeff();
  const Eigen::LDLT<Matrix> ldlt(information + floor * Matrix::Identity());
  if (ldlt.info() != Eigen::Success || !ldlt.isPositive()) return false;
  step = -ldlt.solve(Eigen::Matrix<double, 6, 1>(equations.gradient));
  if (!step.allFinite()) return false;
  const double longest =
      std::max(step.head<3>().norm() / kLongestStepM, step.tail<3>().norm() / kLongestStepRad);
  if (longest > 1) step /= longest;
  return true;
}

}  // namespace paloc
