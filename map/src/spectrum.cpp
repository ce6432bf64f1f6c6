#include "paloc/map/spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace paloc {
namespace {

using Square = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kMinPoints = 12;  // two for each of six directions
constexpr double kMinEigenvalue = 1e-6;

// Of rows J = [n, p x n / length], divided by their number.
Square hessian(std::span<const TwoNormals> points, Vec3 TwoNormals::*normal, double length_m) {
  Square sum = Square::Zero();
  for (const TwoNormals& p : points) {
    Eigen::Matrix<double, 6, 1> j;
    j.head<3>() = p.*normal;
    j.tail<3>() = p.point_body.cross(p.*normal) / length_m;
    sum.selfadjointView<Eigen::Lower>().rankUpdate(j);
  }
  sum /= static_cast<double>(points.size());
  return sum;  // the lower half, which is what the eigensolver reads
}

struct Pair {
  Eigen::Index scan = 0, map = 0;
};

// The pair of the smallest angle of those left (cosines; those used are negative).
Pair closest(const Square& cosines) {
  Pair pair;
  cosines.maxCoeff(&pair.scan, &pair.map);
  return pair;
}

}  // namespace

double spectrumDifference(std::span<const TwoNormals> points) {
  if (points.size() < kMinPoints) return std::numeric_limits<double>::quiet_NaN();
  double squares = 0;
  for (const TwoNormals& p : points) squares += p.point_body.squaredNorm();
  const double length_m = std::sqrt(squares / static_cast<double>(points.size()));
  if (!(length_m > 0)) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::SelfAdjointEigenSolver<Square> scan(
      hessian(points, &TwoNormals::scan_normal, length_m));
  const Eigen::SelfAdjointEigenSolver<Square> map(
      hessian(points, &TwoNormals::map_normal, length_m));
  Square cosines = (scan.eigenvectors().transpose() * map.eigenvectors()).cwiseAbs();
  double difference = 0;
  for (int i = 0; i < 6; ++i) {
    const Pair pair = closest(cosines);
    const double apart = std::max(1 - cosines(pair.scan, pair.map), 0.0);
    difference += apart * apart / std::max(scan.eigenvalues()[pair.scan], kMinEigenvalue);
    cosines.row(pair.scan).setConstant(-1);
    cosines.col(pair.map).setConstant(-1);
  }
  return difference;
}

}  // namespace paloc
