#include "paloc/frontends/plane_voxels.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "voxel_key.h"

namespace paloc {
namespace {

constexpr std::uint64_t kBehind = std::uint64_t{1} << 63;  // the free bit of a voxel's key
constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::size_t kFewestSlots = 1 << 12;

constexpr std::uint32_t kFewestPoints = 10, kMostPoints = 250;
constexpr double kGainToRefit = 1.3;
constexpr double kMaxThickness = 0.1;         // m
constexpr double kMaxThicknessToWidth = 0.4;  // above: an edge, or a single ring of points
constexpr double kMinWidthToLength = 0.15;    // below: a line, whose normal is free to roll
constexpr double kMaxNormalSigma = 0.05;      // rad
constexpr double kBehindCosine = 0.17;        // seen from behind, and not merely along it

// How unsure (rad) the normal is of a plane that is fitted along the mean ray `view` (unit), as the
// noise of ranges is: depth over bearing, of points with this mean scatter (m2). Spread along the
// rays tells nothing of it: the points of a single ring on a wall, an arc with noise beside it
// along the rays, lie on a plane through the sensor as far as their scatter alone tells.
//
// A slope whose sign is not sure is that of any plane about its axis, so the angle between slopes
// two sigmas off counts, and not its derivative.
double normalSigma(const Mat3& scatter, const Vec3& view, double points) {
  constexpr double kSigmas = 2;
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = view.unitOrthogonal();
  across.col(1) = view.cross(across.col(0));
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> bearings;
  bearings.computeDirect(across.transpose() * scatter * across);
  const Eigen::Vector2d spread_sq = bearings.eigenvalues();
  if (!(spread_sq[0] > 0)) return std::numbers::pi;
  const Eigen::Vector2d along = (across * bearings.eigenvectors()).transpose() * scatter * view;
  const Eigen::Vector2d slope = along.cwiseQuotient(spread_sq);
  const double noise = std::max(view.dot(scatter * view) - along.dot(slope), 0.0);
  const Eigen::Vector2d off = kSigmas * (noise / points * spread_sq.cwiseInverse()).cwiseSqrt();
  Eigen::Vector2d angle;
  for (int i = 0; i < 2; ++i) {
    const double other = std::hypot(1, std::max(std::abs(slope[1 - i]) - off[1 - i], 0.0));
    angle[i] = std::atan((slope[i] + off[i]) / other) - std::atan((slope[i] - off[i]) / other);
  }
  return angle.norm() / (2 * kSigmas);
}

// Fibonacci hashing, for tables whose size is a power of two.
std::size_t hashOf(std::uint64_t key) {
  key ^= key >> 32;
  key *= 0x9e3779b97f4a7c15ULL;
  return static_cast<std::size_t>(key ^ key >> 29);
}

}  // namespace

std::uint32_t PlaneVoxels::lookUp(std::uint64_t key) const {
  if (slots_.empty()) return kNone;
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t at = hashOf(key) & mask;; at = (at + 1) & mask) {
    const Slot& slot = slots_[at];
    if (slot.cell == kNone || slot.key == key) return slot.cell;
  }
}

std::uint32_t PlaneVoxels::lookUpOrMake(std::uint64_t key) {
  if (2 * (cells_.size() + 1) > slots_.size()) rebuildSlots(cells_.size() + 1);
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = hashOf(key) & mask;
  while (slots_[at].cell != kNone && slots_[at].key != key) at = (at + 1) & mask;
  if (slots_[at].cell == kNone) {
    slots_[at] = {key, static_cast<std::uint32_t>(cells_.size())};
    cells_.push_back({.key = key});
    planes_.emplace_back();
  }
  return slots_[at].cell;
}

void PlaneVoxels::rebuildSlots(std::size_t count) {
  slots_.assign(std::max(kFewestSlots, std::bit_ceil(4 * count)), {0, kNone});
  const std::size_t mask = slots_.size() - 1;
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
    std::size_t at = hashOf(cells_[cell].key) & mask;
    while (slots_[at].cell != kNone) at = (at + 1) & mask;
    slots_[at] = {cells_[cell].key, cell};
  }
}

bool PlaneVoxels::add(const Vec3& point, const Vec3& ray, std::uint32_t now) {
  const auto key = voxelKeyOf(point, edge_m_);
  if (!key) return false;
  std::uint32_t index = lookUpOrMake(*key);
  cells_[index].seen = now;
  const Plane& front = planes_[index];
  if (front.thickness >= 0) {
    const Vec3 normal(front.nx, front.ny, front.nz);
    if (normal.dot(ray) > kBehindCosine * ray.norm()) {
      index = lookUpOrMake(*key | kBehind);
      cells_[index].seen = now;
    }
  }
  Cell& cell = cells_[index];
  if (cell.points >= kMostPoints) return true;
  const Eigen::Vector3f p = (point - voxelCentre(*key, edge_m_)).cast<float>();
  const float share = 1 / static_cast<float>(++cell.points);
  Eigen::Map<Eigen::Vector3f> mean(cell.mean.data());
  const Eigen::Vector3f before = p - mean;
  mean += share * before;
  const Eigen::Vector3f after = p - mean;
  Eigen::Map<Eigen::Vector3f> view(cell.view.data());
  view += share * (ray.normalized().cast<float>() - view);
  std::size_t at = 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) cell.scatter[at++] += before[row] * after[column];
  }
  const bool gained =
      static_cast<double>(cell.points) >= kGainToRefit * static_cast<double>(cell.fitted) ||
      cell.points == kMostPoints;
  if (cell.points >= kFewestPoints && gained) fit(index, ray);
  return true;
}

void PlaneVoxels::fit(std::uint32_t index, const Vec3& ray) {
  Cell& cell = cells_[index];
  Plane& plane = planes_[index];
  cell.fitted = cell.points;
  plane.thickness = -1;
  const auto& s = cell.scatter;
  Eigen::Matrix3f scatter;
  scatter << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(scatter.cast<double>());
  const auto sigma = [&](int axis, int parameters) {
    return std::sqrt(std::max(solver.eigenvalues()[axis], 0.0) /
                     (static_cast<double>(cell.points) - parameters));
  };
  const double thickness = sigma(0, 3), width = sigma(1, 1), length = sigma(2, 1);
  if (thickness > kMaxThickness || thickness > kMaxThicknessToWidth * width ||
      width < kMinWidthToLength * length ||
      thickness > kMaxNormalSigma * width * std::sqrt(static_cast<double>(cell.points))) {
    return;
  }
  const Vec3 view = Eigen::Map<const Eigen::Vector3f>(cell.view.data()).cast<double>();
  const auto points = static_cast<double>(cell.points);
  if (normalSigma(scatter.cast<double>() / points, view.normalized(), points - 3) >
      kMaxNormalSigma) {
    return;
  }
  Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
  if (normal.cast<double>().dot(ray) > 0) normal = -normal;
  plane = {normal.x(),
           normal.y(),
           normal.z(),
           cell.mean[0],
           cell.mean[1],
           cell.mean[2],
           static_cast<float>(thickness),
           static_cast<float>(width)};
}

bool PlaneVoxels::find(const Vec3& point, const Vec3& ray, LocalPlane& found) const {
  const auto key = voxelKeyOf(point, edge_m_);
  if (!key) return false;
  for (const std::uint64_t side : {std::uint64_t{0}, kBehind}) {
    const std::uint32_t index = lookUp(*key | side);
    if (index == kNone) return false;
    const Plane& plane = planes_[index];
    if (plane.thickness < 0) return false;
    found.normal = Vec3(plane.nx, plane.ny, plane.nz);
    if (found.normal.dot(ray) >= 0) continue;
    found.centroid = voxelCentre(*key, edge_m_) + Vec3(plane.cx, plane.cy, plane.cz);
    found.thickness_m = static_cast<double>(plane.thickness);
    found.width_m = static_cast<double>(plane.width);
    found.points = static_cast<int>(cells_[index].fitted);
    return true;
  }
  return false;
}

void PlaneVoxels::forget(const Vec3& around, double max_distance_m, std::size_t max_voxels) {
  std::vector<bool> kept(cells_.size());
  std::vector<std::uint32_t> seen;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    kept[i] = (voxelCentre(cells_[i].key, edge_m_) - around).squaredNorm() <=
              max_distance_m * max_distance_m;
    if (kept[i]) seen.push_back(cells_[i].seen);
  }
  if (seen.size() > max_voxels) {
    std::size_t surplus = seen.size() - (max_voxels - max_voxels / 4);
    const auto last = seen.begin() + static_cast<std::ptrdiff_t>(surplus - 1);
    std::nth_element(seen.begin(), last, seen.end());
    const std::uint32_t youngest_to_go = *last;
    surplus -= static_cast<std::size_t>(
        std::count_if(seen.begin(), last, [&](std::uint32_t t) { return t < youngest_to_go; }));
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (!kept[i] || cells_[i].seen > youngest_to_go) continue;
      // Of those seen last at that very time, only as many as have to.
      const bool tie = cells_[i].seen == youngest_to_go;
      if (tie && surplus == 0) continue;
      if (tie) --surplus;
      kept[i] = false;
    }
  }
  if (std::find(kept.begin(), kept.end(), false) != kept.end()) keepOnly(kept);
}

void PlaneVoxels::keepOnly(const std::vector<bool>& kept) {
  std::size_t to = 0;
  for (std::size_t from = 0; from < cells_.size(); ++from) {
    if (!kept[from]) continue;
    cells_[to] = cells_[from];
    planes_[to++] = planes_[from];
  }
  cells_.resize(to);
  planes_.resize(to);
  rebuildSlots(cells_.size());
}

void PlaneVoxels::clear() {
  slots_.clear();
  cells_.clear();
  planes_.clear();
}

std::size_t PlaneVoxels::bytes() const {
  return slots_.capacity() * sizeof(Slot) + cells_.capacity() * sizeof(Cell) +
         planes_.capacity() * sizeof(Plane);
}

}  // namespace paloc
