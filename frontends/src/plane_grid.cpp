#include "plane_grid.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace paloc {
namespace {

constexpr int kFewestPoints = 8;
constexpr double kRefit = 1.3;       // after so many times more points
constexpr double kThickest = 0.08;   // m, standard deviation across the plane
constexpr double kNarrowest = 0.08;  // of the voxel, standard deviation along its narrower side
constexpr double kFlattest = 3;      // narrower side over thickness, at least

}  // namespace

std::uint64_t PlaneGrid::keyOf(const Vec3& point, Vec3& corner) const {
  constexpr std::uint64_t kMask = (1U << 21U) - 1;
  const Vec3 cell = (point * inverse_).array().floor();
  corner = cell * voxel_m_;
  const auto part = [&](int axis) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[axis])) & kMask;
  };
  return part(0) | part(1) << 21U | part(2) << 42U;
}

void PlaneGrid::add(const Vec3& point) {
  Vec3 corner;
  Cell& cell = cells_[keyOf(point, corner)];
  const Vec3 p = point - corner;
  ++cell.count;
  cell.sum += p;
  cell.squares += p * p.transpose();
}

void PlaneGrid::fit(Cell& cell, const Vec3& corner) const {
  const double n = cell.count;
  const Vec3 mean = cell.sum / n;
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(cell.squares / n - mean * mean.transpose());
  const Vec3 spread = eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
  cell.fitted = cell.count;
  cell.planar = spread[0] < kThickest && spread[1] > kNarrowest * voxel_m_ &&
                spread[1] > kFlattest * spread[0];
  cell.plane = {corner + mean, eigen.eigenvectors().col(0)};
}

std::optional<PlaneGrid::Plane> PlaneGrid::at(const Vec3& point) {
  Vec3 corner;
  const auto found = cells_.find(keyOf(point, corner));
  if (found == cells_.end()) return std::nullopt;
  Cell& cell = found->second;
  if (cell.count < kFewestPoints) return std::nullopt;
  if (cell.count > kRefit * cell.fitted) fit(cell, corner);
  if (!cell.planar) return std::nullopt;
  return cell.plane;
}

}  // namespace paloc
