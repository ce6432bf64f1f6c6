#include "plane_fitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "neighbourhood.h"
#include "parallel_chunks.h"
#include "plane_moments.h"
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

Point3f operator-(const Point3f& a, const Point3f& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

float normSq(const Point3f& p) { return p.x * p.x + p.y * p.y + p.z * p.z; }

/// Fits the planes of one block after the other.
class BlockFitter {
 public:
  BlockFitter(const PointIndex& index, const MapSettings& settings)
      : index_(index),
        neighbourhood_(index),
        wanted_(static_cast<std::size_t>(std::max(settings.plane_neighbours, 3))),
        limits_{.max_thickness_m = settings.plane_max_thickness_m},
        clean_m_(static_cast<float>(limits_.clean_thickness_m)),
        max_radius_m_(static_cast<float>(settings.plane_max_radius_m)) {}

  void fit(std::size_t block, PackedPlane* planes);

 private:
  void fitTogether(const Point3f& centre, float half_width_m);
  float gatherAbout(const Point3f& centre, const Point3f& middle, float half_width_m);
  MapPlane planeAt(const Point3f& from, float radius_sq);
  void share(std::size_t from, float radius_sq, std::array<bool, PointBlock::kPoints>& fitted);

  const PointIndex& index_;
  Neighbourhood neighbourhood_;
  std::size_t wanted_;
  PlaneFitLimits limits_;
  float clean_m_, max_radius_m_;
  std::array<Point3f, PointBlock::kPoints> points_{};
  std::array<MapPlane, PointBlock::kPoints> planes_{};
  std::size_t count_ = 0;
  std::vector<float> scratch_;
};

// Gathers what the neighbourhoods of the points about a centre can hold; returns their radius.
float BlockFitter::gatherAbout(const Point3f& centre, const Point3f& middle, float half_width_m) {
  const float middle_off = std::sqrt(normSq(middle));
  float radius = std::min(std::max(kFirstRadius * half_width_m, kLeastRadiusM), max_radius_m_);
  for (;;) {
    neighbourhood_.gather(centre, half_width_m + radius);
    // Up to here the middle point has seen all its neighbours.
    const float seen = half_width_m + radius - middle_off;
    const float distance_sq = neighbourhood_.distanceSq(middle, wanted_);
    if (distance_sq <= seen * seen) {
      radius = std::min(std::max(std::sqrt(distance_sq), kLeastRadiusM), max_radius_m_);
      break;
    }
    if (radius >= max_radius_m_) break;
    radius = std::min(kRadiusGrowth * radius, max_radius_m_);
  }
  return radius;
}

MapPlane BlockFitter::planeAt(const Point3f& from, float radius_sq) {
  const Neighbourhood::Sums within = neighbourhood_.sumsWithin(from, radius_sq);
  if (within.count < std::max(limits_.min_points, 3)) return planeOf({}, limits_);
  const PlaneMoments moments(within.sums, within.count);
  if (moments.variances[0] <= limits_.clean_thickness_m * limits_.clean_thickness_m) {
    return planeOf(moments, limits_);
  }
  const std::span<const Point3f> points = neighbourhood_.pointsWithin(from, radius_sq);
  scratch_.resize(std::max(scratch_.size(), points.size()));
  return fitPlane(points, limits_, scratch_);
}

// The planes of the points (relative to the centre, none further from it than the half width).
void BlockFitter::fitTogether(const Point3f& centre, float half_width_m) {
  std::size_t middle = 0;
  for (std::size_t i = 1; i < count_; ++i) {
    if (normSq(points_[i]) < normSq(points_[middle])) middle = i;
  }
  const float radius = gatherAbout(centre, points_[middle], half_width_m);
  const float radius_sq = radius * radius;
  std::array<bool, PointBlock::kPoints> fitted{};
  for (std::size_t k = 0; k < count_; ++k) {
    const std::size_t at = (middle + k) % count_;  // the middle one first
    if (fitted[at]) continue;
    planes_[at] = planeAt(points_[at], radius_sq);
    fitted[at] = true;
    if (planes_[at].planar() && planes_[at].thickness_m <= clean_m_) share(at, radius_sq, fitted);
  }
}

// Gives the plane of one point to those that have none yet and lie on it.
void BlockFitter::share(std::size_t from, float radius_sq,
                        std::array<bool, PointBlock::kPoints>& fitted) {
  const MapPlane plane = planes_[from];
  const float near = std::max(kSharedOffset * plane.thickness_m, kSharedOffsetM);
  for (std::size_t i = 0; i < count_; ++i) {
    if (fitted[i]) continue;
    const Point3f apart = points_[i] - points_[from];
    const float offset =
        plane.offset_m - (plane.nx * apart.x + plane.ny * apart.y + plane.nz * apart.z);
    if (std::abs(offset) > near || normSq(apart) > kSharedReach * kSharedReach * radius_sq)
      continue;
    planes_[i] = plane;
    planes_[i].offset_m = offset;
    fitted[i] = true;
  }
}

void BlockFitter::fit(std::size_t block, PackedPlane* planes) {
  const std::size_t first = block * PointBlock::kPoints;
  count_ = std::min(PointBlock::kPoints, index_.size() - first);
  Point3f low = index_.point(static_cast<std::uint32_t>(first)), high = low;
  for (std::size_t i = 0; i < count_; ++i) {
    const Point3f p = points_[i] = index_.point(static_cast<std::uint32_t>(first + i));
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Point3f centre{low.x + (high.x - low.x) / 2, low.y + (high.y - low.y) / 2,
                       low.z + (high.z - low.z) / 2};
  float half_width_sq = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    half_width_sq = std::max(half_width_sq, normSq(points_[i] - centre));
  }
  if (half_width_sq <= max_radius_m_ * max_radius_m_) {
    for (std::size_t i = 0; i < count_; ++i) points_[i] = points_[i] - centre;
    fitTogether(centre, std::sqrt(half_width_sq));
    for (std::size_t i = 0; i < count_; ++i) planes[i] = PackedPlane(planes_[i]);
    return;
  }
  // The curve leaps within the block: each point by itself.
  const std::array<Point3f, PointBlock::kPoints> points = points_;
  const std::size_t count = std::exchange(count_, 1);
  for (std::size_t i = 0; i < count; ++i) {
    points_[0] = {};
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
      fitter.fit(block, planes.data() + block * PointBlock::kPoints);
    }
  });
  turnFacesToTheirViewers(index, planes, arena);
  return planes;
}

}  // namespace paloc
