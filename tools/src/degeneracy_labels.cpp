#include "paloc/tools/degeneracy_labels.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace paloc {
namespace {

constexpr double kFullToDegenerate = 5;  // in standard deviations
constexpr double kRounding = 1e-11;      // of the largest eigenvalue, below: zero

using Eigenvectors = Eigen::SelfAdjointEigenSolver<Mat3>;

Mat3 pseudoInverse(const Mat3& block) {
  const Eigenvectors solver(block);
  Vec3 inverse = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const double value = solver.eigenvalues()[i];
    if (value > kRounding * solver.eigenvalues()[2]) inverse[i] = 1 / value;
  }
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

DirectionLabel labelOf(double sigma, double bound) {
  if (sigma > bound) return DirectionLabel::kDegenerate;
  return sigma * kFullToDegenerate > bound ? DirectionLabel::kWeak : DirectionLabel::kFull;
}

}  // namespace

LabelledDirections labelDirections(std::span<const ExactPoint> points, double range_noise_m) {
  Mat6 information = Mat6::Zero();
  for (const ExactPoint& point : points) {
    Vec6 j;
    j << point.normal_body, point.position_body.cross(point.normal_body);
    information += j * j.transpose();
  }
  LabelledDirections labelled;
  for (const int own : {0, 3}) {
    const int other = 3 - own;
    const Mat3 block = information.block<3, 3>(own, own);
    const Mat3 cross = information.block<3, 3>(own, other);
    const Eigenvectors solver(block - cross * pseudoInverse(information.block<3, 3>(other, other)) *
                                          cross.transpose());
    const double zero = kRounding * block.trace();
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(own + i);
      const double value = solver.eigenvalues()[i];
      labelled.axis_body[k] = solver.eigenvectors().col(i);
      labelled.sigma[k] =
          value > zero ? range_noise_m / std::sqrt(value) : std::numeric_limits<double>::infinity();
      labelled.label[k] =
          labelOf(labelled.sigma[k], own == 0 ? kDegenerateSigmaM : kDegenerateSigmaRad);
    }
  }
  return labelled;
}

}  // namespace paloc
