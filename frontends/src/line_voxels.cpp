#include "paloc/frontends/line_voxels.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "voxel_key.h"

namespace paloc {
namespace {

constexpr std::uint32_t kFewestPoints = 6;
constexpr double kMaxThickness = 0.06;         // m, in the wider direction across
constexpr double kMaxThicknessToLength = 0.3;  // above: a patch or a corner

}  // namespace

bool LineVoxels::add(const Vec3& point) {
  const auto key = voxelKeyOf(point, edge_m_);
  if (!key) return false;
  const Vec3 centre = voxelCentre(*key, edge_m_);
  Cell& cell = cells_[*key];
  const Vec3 before = point - centre - cell.mean;
  cell.mean += before / static_cast<double>(++cell.points);
  const Vec3 after = point - centre - cell.mean;
  std::size_t at = 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) cell.scatter[at++] += before[row] * after[column];
  }
  if (cell.points >= kFewestPoints) fit(cell, centre);
  return true;
}

void LineVoxels::fit(Cell& cell, const Vec3& centre) const {
  const auto& s = cell.scatter;
  Mat3 scatter;
  scatter << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(scatter);
  const Vec3 values = solver.eigenvalues().cwiseMax(0);
  const double n = static_cast<double>(cell.points);
  const double wider = std::sqrt(values[1] / (n - 2)), length = std::sqrt(values[2] / (n - 1));
  cell.is_line = wider < kMaxThickness && wider < kMaxThicknessToLength * length;
  if (!cell.is_line) return;
  cell.line.direction = solver.eigenvectors().col(2);
  cell.line.centroid = centre + cell.mean;
  cell.line.thickness_m = std::sqrt(0.5 * (values[0] + values[1]) / (n - 2));
  cell.line.length_m = length;
  cell.line.points = static_cast<int>(cell.points);
}

bool LineVoxels::find(const Vec3& point, LocalLine& line) const {
  const auto key = voxelKeyOf(point, edge_m_);
  if (!key) return false;
  const auto found = cells_.find(*key);
  if (found == cells_.end() || !found->second.is_line) return false;
  line = found->second.line;
  return true;
}

std::size_t LineVoxels::bytes() const {
  return cells_.size() * (sizeof(std::uint64_t) + sizeof(Cell) + 2 * sizeof(void*)) +
         cells_.bucket_count() * sizeof(void*);
}

}  // namespace paloc
