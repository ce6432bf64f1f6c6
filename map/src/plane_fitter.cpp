#include "plane_fitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "neighbourhood.h"
#include "parallel_chunks.h"
#include "plane_fit.h"
#include "point_vector.h"
#include "wall_faces.h"

namespace paloc {
namespace {

constexpr std::size_t kChunk = 512;  // blocks
constexpr float kFirstRadius = 1.6F, kRadiusGrowth = 1.5F;
constexpr float kLeastRadiusM = 0.03F;
// A point shares the plane of its block when it lies this near to it, in thicknesses.
constexpr float kSharedOffset = 2.5F, kSharedOffsetM = 5e-4F;
// And this near to the point it was fitted about, in radii: a plane is worse towards its rim.
constexpr float kSharedReach = 0.6F;

// A point lies on a face that is this near to it, in thicknesses of a clean surface.
constexpr float kKnownOffset = 2.5F;
// The next neighbourhood is gathered within the last one's radius and this much more, so that once
// is mostly enough.
constexpr float kRadiusMargin = 1.1F;
// What is prepared for a group of blocks, so that it mostly holds what they gather.
constexpr float kGroupMargin = 1.3F;

using Vec3f = Eigen::Vector3f;

/// Fits the planes of one block after the other.
class BlockFitter {
 public:
  BlockFitter(const PointIndex& index, const MapSettings& settings)
      : index_(index),
        neighbourhood_(index),
        wanted_(static_cast<std::size_t>(std::max(settings.plane_neighbours, 3))),
        limits_{.max_thickness_m = settings.plane_max_thickness_m},
        fit_(limits_),
        clean_m_(static_cast<float>(limits_.clean_thickness_m)),
        max_radius_m_(static_cast<float>(settings.plane_max_radius_m)) {}

  /// To be called before the first block of each group.
  void beginGroup(std::size_t block);
  void fit(std::size_t block, PackedPlane* planes);

 private:
  using Points = std::array<Vec3f, PointBlock::kPoints>;

  void fitTogether(const Vec3f& centre, float half_width_m);
  float gatherAbout(const Vec3f& centre, const Vec3f& middle, float half_width_m);
  MapPlane planeAt(std::size_t point, float radius_sq);
  bool fitOnKnownFace(std::size_t point, float radius_sq);
  void share(std::size_t from, float radius_sq, std::array<bool, PointBlock::kPoints>& fitted);

  const PointIndex& index_;
  Neighbourhood neighbourhood_;
  std::size_t wanted_;
  PlaneFitLimits limits_;
  PlaneFit fit_;
  float clean_m_, max_radius_m_;
  std::vector<std::size_t> faces_;  // points of the block whose plane is a clean face
  float last_radius_m_ = 0;         // 0: none yet
  Points points_{};
  std::array<MapPlane, PointBlock::kPoints> planes_{};
  std::size_t count_ = 0;
};

// Gathers what the neighbourhoods of the points about a centre can hold; returns their radius.
float BlockFitter::gatherAbout(const Vec3f& centre, const Vec3f& middle, float half_width_m) {
  const auto limited = [this](float radius) {
    return std::min(std::max(radius, kLeastRadiusM), max_radius_m_);
  };
  const float middle_off = middle.norm();
  const float first =
      last_radius_m_ > 0 ? kRadiusMargin * last_radius_m_ : kFirstRadius * half_width_m;
  for (float radius = limited(first);; radius = limited(kRadiusGrowth * radius)) {
    neighbourhood_.gather({centre.x(), centre.y(), centre.z()}, half_width_m + radius);
    // Up to here the middle point has seen all its neighbours.
    const float seen = half_width_m + radius - middle_off;
    const float radius_sq =
        neighbourhood_.radiusSqOf(wanted_, middle, seen * seen, last_radius_m_ * last_radius_m_);
    if (std::isfinite(radius_sq)) return last_radius_m_ = limited(std::sqrt(radius_sq));
    if (radius >= max_radius_m_) return max_radius_m_;
  }
}

// Where the point lies on a face that was found already, but out of its reach: the face's points
// about the point itself, if these are most of all.
bool BlockFitter::fitOnKnownFace(std::size_t point, float radius_sq) {
  for (const std::size_t face : faces_) {
    const MapPlane& known = planes_[face];
    const Vec3f normal(known.nx, known.ny, known.nz);
    const float height = known.offset_m - normal.dot(points_[point] - points_[face]);
    if (std::abs(height) > kKnownOffset * clean_m_) continue;
    const Neighbourhood::Face about = neighbourhood_.faceWithin(
        points_[point], radius_sq, normal, height, PlaneFit::kFaceWithin * clean_m_);
    if (static_cast<float>(about.sums.count) <
        PlaneFit::kWholeShare * static_cast<float>(about.count))
      continue;
    if (thickerThan(limits_.clean_thickness_m * limits_.clean_thickness_m, about.sums)) continue;
    const MapPlane plane = planeOf(PlaneMoments(about.sums), limits_);
    if (!plane.planar() || plane.thickness_m > clean_m_) continue;
    planes_[point] = plane;
    return true;
  }
  return false;
}

MapPlane BlockFitter::planeAt(std::size_t point, float radius_sq) {
  return fit_(neighbourhood_.pointsWithin(points_[point], radius_sq), radius_sq);
}

// The planes of the points (relative to the centre, none further from it than the half width).
void BlockFitter::fitTogether(const Vec3f& centre, float half_width_m) {
  std::size_t middle = 0;
  for (std::size_t i = 1; i < count_; ++i) {
    if (points_[i].squaredNorm() < points_[middle].squaredNorm()) middle = i;
  }
  const float radius = gatherAbout(centre, points_[middle], half_width_m);
  const float radius_sq = radius * radius;
  std::array<bool, PointBlock::kPoints> fitted{};
  faces_.clear();
  for (std::size_t k = 0; k < count_; ++k) {
    const std::size_t at = (middle + k) % count_;  // the middle one first
    if (fitted[at]) continue;
    if (!fitOnKnownFace(at, radius_sq)) planes_[at] = planeAt(at, radius_sq);
    fitted[at] = true;
    if (!planes_[at].planar() || planes_[at].thickness_m > clean_m_) continue;
    faces_.push_back(at);
    share(at, radius_sq, fitted);
  }
}

// Gives the plane of one point to those that have none yet and lie on it.
void BlockFitter::share(std::size_t from, float radius_sq,
                        std::array<bool, PointBlock::kPoints>& fitted) {
  const MapPlane plane = planes_[from];
  const float near = std::max(kSharedOffset * plane.thickness_m, kSharedOffsetM);
  const Vec3f normal(plane.nx, plane.ny, plane.nz);
  for (std::size_t i = 0; i < count_; ++i) {
    if (fitted[i]) continue;
    const Vec3f apart = points_[i] - points_[from];
    const float offset = plane.offset_m - normal.dot(apart);
    if (std::abs(offset) > near || apart.squaredNorm() > kSharedReach * kSharedReach * radius_sq)
      continue;
    planes_[i] = plane;
    planes_[i].offset_m = offset;
    fitted[i] = true;
  }
}

// The blocks of a group have most of their surroundings in common.
void BlockFitter::beginGroup(std::size_t block) {
  const PointIndex::Box box = index_.boxOfGroup(block);
  const Vec3f centre = (box.low + box.high) / 2;
  const float half_width = (box.high - box.low).norm() / 2;
  const bool compact = half_width <= max_radius_m_ && last_radius_m_ > 0;
  neighbourhood_.prepare({centre.x(), centre.y(), centre.z()},
                         compact ? half_width + kGroupMargin * last_radius_m_ : 0);
}

void BlockFitter::fit(std::size_t block, PackedPlane* planes) {
  const std::size_t first = block * PointBlock::kPoints;
  count_ = std::min(PointBlock::kPoints, index_.size() - first);
  Vec3f low = toVec3f(index_.point(static_cast<std::uint32_t>(first))), high = low;
  for (std::size_t i = 0; i < count_; ++i) {
    points_[i] = toVec3f(index_.point(static_cast<std::uint32_t>(first + i)));
    low = low.cwiseMin(points_[i]), high = high.cwiseMax(points_[i]);
  }
  const Vec3f centre = low + (high - low) / 2;
  float half_width_sq = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    half_width_sq = std::max(half_width_sq, (points_[i] - centre).squaredNorm());
  }
  if (half_width_sq <= max_radius_m_ * max_radius_m_) {
    for (std::size_t i = 0; i < count_; ++i) points_[i] -= centre;
    fitTogether(centre, std::sqrt(half_width_sq));
    for (std::size_t i = 0; i < count_; ++i) planes[i] = PackedPlane(planes_[i]);
    return;
  }
  // The curve leaps within the block: each point by itself.
  const Points points = points_;
  const std::size_t count = std::exchange(count_, 1);
  for (std::size_t i = 0; i < count; ++i) {
    points_[0] = Vec3f::Zero();
    fitTogether(points[i], 0);
    planes[i] = PackedPlane(planes_[0]);
  }
}

}  // namespace

PlaneStore fitPlanes(const PointIndex& index, const MapSettings& settings, tbb::task_arena& arena) {
  PlaneStore planes(index.size());
  forEachChunk(arena, index.blocks(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    BlockFitter fitter(index, settings);
    for (std::size_t block = begin; block < end; ++block) {
      if (block % BoxGroup::kBoxes == 0) fitter.beginGroup(block);
      fitter.fit(block, planes.data() + block * PointBlock::kPoints);
    }
  });
  turnFacesToTheirViewers(index, planes, arena);
  return planes;
}

}  // namespace paloc
