#include "plane_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lanes4.h"

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
// Points of a face that are nearer than this, in radii, to one off it may belong to what meets it
// there.
constexpr float kAtEdge = 0.5F;
// Standard deviation of the heights of what lies off a face, in thicknesses of a clean surface: up
// to it, it is another face parallel to it.
constexpr float kParallelSpread = 1.5F;
constexpr std::size_t kFew = 64;  // numbers, up to which to count is quicker than to sort

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

constexpr float kAnyRadius = std::numeric_limits<float>::infinity();

// Moments of the points whose height over the plane through the origin lies in [low, high].
PlaneMoments momentsBetween(const NearPoints& points, const Vec3f& normal, float low, float high) {
  return PlaneMoments(toMomentSums(pointKernels().sumsIn(
      points.columns(), {{0, 0, 0}, kAnyRadius, toPlace(normal), low, high})));
}

MomentSums sumsWithin(const NearPoints& points, float radius_sq) {
  return toMomentSums(pointKernels().sumsWithin(points.columns(), {0, 0, 0}, radius_sq));
}

}  // namespace

// The plane through the origin and two of the nearer points that the most points lie on, if these
// are a good part of all: one face of an edge, a corner or a thin wall.
bool PlaneFit::findConsensus(const NearPoints& points, float near_sq, Vec3f& normal) const {
  // Evenly among all: those that follow each other lie side by side.
  std::array<Vec3f, kTriedPoints> tried;
  std::array<float, kTriedPoints> tried_sq{};
  std::size_t count = 0;
  const std::size_t step = std::max<std::size_t>(points.size() / (2 * kTriedPoints), 1);
  for (std::size_t first = 0; first < step && count < kTriedPoints; ++first) {
    for (std::size_t i = first; i < points.size() && count < kTriedPoints; i += step) {
      const Vec3f point = points[i];
      const float apart_sq = point.squaredNorm();
      if (apart_sq <= near_sq) tried_sq[count] = apart_sq, tried[count++] = point;
    }
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
      if (cross_sq <= kTriedSine * kTriedSine * tried_sq[i] * tried_sq[k]) continue;
      const int near = pointKernels().countNearPlane(points.columns(), toPlace(cross),
                                                     within * within * cross_sq);
      if (near > most) most = near, normal = cross;
      if (most >= sure) break;
    }
    if (most >= sure) break;
  }
  if (most < needed) return false;
  normal.normalize();
  return true;
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

// Whether what lies off the face leads up to it, as beyond an edge or in a corner.
bool PlaneFit::meetsAnother(const std::vector<float>& heights_off) const {
  if (heights_off.size() < 2) return false;
  float sum = 0, squares = 0;
  for (const float height : heights_off) {
    sum += std::abs(height);
    squares += height * height;
  }
  const auto count = static_cast<float>(heights_off.size());
  const float variance = squares / count - sum * sum / (count * count);
  const float spread = kParallelSpread * static_cast<float>(limits_.clean_thickness_m);
  return variance > spread * spread;
}

// The face without those of its points that lie at an edge of it: what meets it there begins on
// the face, and a plane through both turns towards it, however thin it is.
PlaneMoments PlaneFit::withoutEdges(const NearPoints& points, const PlaneMoments& face,
                                    float radius_sq) {
  const auto within = static_cast<float>(kFaceWithin * limits_.clean_thickness_m);
  const Vec3f normal = face.normal.cast<float>();
  const auto of_face = static_cast<float>(face.normal.dot(face.centroid));
  heights_.clear(), off_.clear(), on_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float height = normal.dot(points[i]) - of_face;
    const bool on = std::abs(height) <= within;
    (on ? on_ : off_).push_back(points[i]);
    if (!on) heights_.push_back(height);
  }
  if (!meetsAnother(heights_)) return face;
  MomentSums sums;
  for (const Vec3f& point : on_) {
    const bool at_edge = std::any_of(off_.begin(), off_.end(), [&](const Vec3f& off) {
      return (off - point).squaredNorm() < kAtEdge * kAtEdge * radius_sq;
    });
    if (!at_edge) sums.add(double{point.x()}, double{point.y()}, double{point.z()});
  }
  return PlaneMoments(sums);
}

// The band of heights over the plane (through the origin) that belongs to the face of the point
// itself: where the sorted heights show a gap much wider than either side is thick, the side of the
// point; then, what lies within three robust standard deviations of that side's median.
PlaneFit::Band PlaneFit::ownFace(const NearPoints& points, const PlaneMoments& m) {
  const Vec3f normal = m.normal.cast<float>();
  heights_.resize(points.size() + PointBlock::kPoints);
  pointKernels().heights(points.columns(), toPlace(normal), heights_.data());
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
  const MomentSums all = sumsWithin(points, radius_sq);
  if (all.count < limits_.min_points || !thickerThan(cleanVariance(), all)) {
    return planeOf(PlaneMoments(all), limits_);
  }
  const float near_sq = radius_sq / 2;  // of a surface, half of the points
  Vec3f normal = Vec3f::Zero();
  if (findConsensus(points, near_sq, normal)) {
    const PlaneMoments face = momentsOnFace(points, normal);
    const MapPlane plane = planeOf(face, limits_);
    if (plane.planar() && face.variances[0] <= kFaceClean * cleanVariance()) {
      return planeOf(withoutEdges(points, face, radius_sq), limits_);
    }
  }
  // Two faces as far apart as the neighbourhood is wide make the normal of all its points turn:
  // then the nearer half, which is mostly the point's own face, shows it better.
  PlaneMoments m(all);
  const PlaneMoments nearer(sumsWithin(points, near_sq));
  if (nearer.count >= 3 &&
      nearer.variances[0] * m.variances[1] < m.variances[0] * nearer.variances[1]) {
    m = nearer;
  }
  const Band band = ownFace(points, m);
  const PlaneMoments refined = momentsBetween(points, m.normal.cast<float>(), band.low, band.high);
  return planeOf(refined.count >= limits_.min_points ? refined : m, limits_);
}

}  // namespace paloc
