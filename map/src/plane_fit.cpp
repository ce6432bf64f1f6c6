#include "plane_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace paloc {
namespace {

using Vec3f = Eigen::Vector3f;

constexpr double kMinGapToSpread = 2.0;  // two faces: the gap against the spread of either side
// A face among several: the share of the points on it from which no other can be much better; its
// square thickness at most, in that of a clean surface; points that planes are tried through; sine
// of the angle between two of them.
constexpr double kSureShare = 0.7, kFaceClean = 2.25;
constexpr std::size_t kTriedPoints = 6;
constexpr float kTriedSine = 0.3F;
constexpr std::size_t kFew = 64;  // numbers, up to which to count is quicker than to sort

Float4 heightOver(const Vec3f& normal, const Float4& x, const Float4& y, const Float4& z) {
  return x * normal.x() + y * normal.y() + z * normal.z();
}

int countNear(const NearPoints& points, const Vec3f& normal, float within_m) {
  const float within_sq = within_m * within_m;
  Mask4 count{};
  points.forEach4([&](const Float4& x, const Float4& y, const Float4& z) {
    const Float4 height = heightOver(normal, x, y, z);
    count -= height * height < within_sq;  // a lane that holds is -1
  });
  return count[0] + count[1] + count[2] + count[3];
}

// Sorts a few numbers, of which there is room for four more: each goes to the place that the
// smaller ones leave to it, counted four at once and without a branch that cannot be foreseen.
void sortFew(std::vector<float>& values, std::size_t count, std::vector<float>& sorted) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(count), 4, kNone);
  sorted.assign(count, kNone);
  for (std::size_t i = 0; i < count; ++i) {
    Mask4 smaller{};
    for (std::size_t k = 0; k < count; k += 4) smaller -= load4(values.data() + k) < values[i];
    const int place = smaller[0] + smaller[1] + smaller[2] + smaller[3];
    sorted[static_cast<std::size_t>(place)] = values[i];
  }
  // Of equal ones all went to one place.
  for (std::size_t i = 1; i < count; ++i) {
    if (std::isnan(sorted[i])) sorted[i] = sorted[i - 1];
  }
}

// Moments of the points whose height over the plane through the origin lies in [low, high].
PlaneMoments momentsBetween(const NearPoints& points, const Vec3f& normal, float low, float high) {
  return PlaneMoments(points.sumsWhere([&](const Float4& x, const Float4& y, const Float4& z) {
    const Float4 height = heightOver(normal, x, y, z);
    return (height >= low) & (height <= high);
  }));
}

}  // namespace

// The plane through the origin and two of the nearer points that the most points lie on, if these
// are a good part of all: one face of an edge, a corner or a thin wall.
bool PlaneFit::findConsensus(const NearPoints& points, float near_sq, Vec3f& normal) const {
  std::array<Vec3f, kTriedPoints> tried;
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size() && count < kTriedPoints; ++i) {
    if (points[i].squaredNorm() <= near_sq) tried[count++] = points[i];
  }
  const auto within = static_cast<float>(kFaceWithin * limits_.clean_thickness_m);
  const auto share = [&](double of) {
    return static_cast<int>(of * static_cast<double>(points.size()));
  };
  const int needed = std::max(limits_.min_points + 3, share(double{kFaceShare}));
  const int sure = std::max(needed, share(kSureShare));
  int most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) {
      const Vec3f cross = tried[i].cross(tried[k]);
      const float cross_sq = cross.squaredNorm();
      if (cross_sq < kTriedSine * kTriedSine * tried[i].squaredNorm() * tried[k].squaredNorm() ||
          cross_sq == 0) {
        continue;
      }
      const Vec3f candidate = cross / std::sqrt(cross_sq);
      const int near = countNear(points, candidate, within);
      if (near > most) most = near, normal = candidate;
      if (most >= sure) return true;
    }
  }
  return most >= needed;
}

// Moments of the points near to that plane, twice, each time nearer to what was found.
PlaneMoments PlaneFit::momentsOnFace(const NearPoints& points, const Vec3f& normal) const {
  const auto within = static_cast<float>(kFaceWithin * limits_.clean_thickness_m);
  const PlaneMoments near = momentsBetween(points, normal, -within, within);
  if (near.count < limits_.min_points) return {};
  const Vec3f better = near.normal.cast<float>();
  const auto height = static_cast<float>(near.normal.dot(near.centroid));
  const PlaneMoments nearer = momentsBetween(points, better, height - within, height + within);
  return nearer.count < limits_.min_points ? PlaneMoments() : nearer;
}

// The band of heights over the plane (through the origin) that belongs to the face of the point
// itself: where the sorted heights show a gap much wider than either side is thick, the side of the
// point; then, what lies within three robust standard deviations of that side's median.
PlaneFit::Band PlaneFit::ownFace(const NearPoints& points, const PlaneMoments& m) {
  const Vec3f normal = m.normal.cast<float>();
  heights_.resize(points.size() + 4);
  std::size_t at = 0;
  points.forEach4([&](const Float4& x, const Float4& y, const Float4& z) {
    store4(heights_.data() + at, heightOver(normal, x, y, z));
    at += 4;
  });
  if (points.size() <= kFew) {
    sortFew(heights_, points.size(), sorted_);
    heights_.swap(sorted_);
  } else {
    heights_.resize(points.size());  // without the lanes that are none
    std::sort(heights_.begin(), heights_.end());
  }
  std::size_t begin = 0, end = heights_.size(), cut = 0;
  float gap = 0;
  for (std::size_t i = 1; i < heights_.size(); ++i) {
    if (heights_[i] - heights_[i - 1] > gap) gap = heights_[i] - heights_[i - 1], cut = i;
  }
  const float thickest =
      std::max(heights_[cut > 0 ? cut - 1 : 0] - heights_.front(), heights_.back() - heights_[cut]);
  if (static_cast<double>(gap) > 4 * limits_.clean_thickness_m &&
      static_cast<double>(gap) > kMinGapToSpread * static_cast<double>(thickest) / 2) {
    (0 < heights_[cut] ? end : begin) = cut;
  }
  const std::size_t count = end - begin;
  const float median = heights_[begin + count / 2];
  // Half of the middle half: 0.6745 standard deviations of a normal distribution.
  const float half_quartiles =
      (heights_[begin + (3 * count) / 4] - heights_[begin + count / 4]) / 2;
  const float sigma =
      std::max(half_quartiles / 0.6745F, static_cast<float>(limits_.clean_thickness_m) / 2);
  return {std::max(heights_[begin], median - 3 * sigma),
          std::min(heights_[end - 1], median + 3 * sigma)};
}

MapPlane PlaneFit::operator()(const NearPoints& points, float radius_sq) {
  const auto within = [radius_sq](const Float4& x, const Float4& y, const Float4& z) {
    return x * x + y * y + z * z <= radius_sq;  // not what fills the last lanes
  };
  return (*this)(points, radius_sq, PlaneMoments(points.sumsWhere(within)));
}

MapPlane PlaneFit::operator()(const NearPoints& points, float radius_sq, const PlaneMoments& all) {
  if (all.count < limits_.min_points || clean(all.variances[0], 1)) return planeOf(all, limits_);
  const float near_sq = radius_sq / 2;  // of a surface, half of the points
  Vec3f normal = Vec3f::Zero();
  if (findConsensus(points, near_sq, normal)) {
    const PlaneMoments face = momentsOnFace(points, normal);
    const MapPlane plane = planeOf(face, limits_);
    if (plane.planar() && clean(face.variances[0], kFaceClean)) return plane;
  }
  // Two faces as far apart as the neighbourhood is wide make the normal of all its points turn:
  // then the nearer half, which is mostly the point's own face, shows it better.
  PlaneMoments m = all;
  const PlaneMoments nearer(
      points.sumsWhere([&](const Float4& x, const Float4& y, const Float4& z) {
        return x * x + y * y + z * z <= near_sq;
      }));
  if (nearer.count >= 3 &&
      nearer.variances[0] * m.variances[1] < m.variances[0] * nearer.variances[1]) {
    m = nearer;
  }
  const Band band = ownFace(points, m);
  const PlaneMoments refined = momentsBetween(points, m.normal.cast<float>(), band.low, band.high);
  return planeOf(refined.count >= limits_.min_points ? refined : m, limits_);
}

}  // namespace paloc
