#include "start_verification.h"

#include <algorithm>
#include <cmath>

#include "map_coverage.h"
#include "point_vector.h"

namespace paloc {
namespace {

constexpr double kRayStepM = 0.2;
constexpr double kRayMarginM = 0.5;  // before the end of a ray: that surface may be a little nearer
constexpr double kOnMapM = 0.08;     // this near to a map point is on its surface
// Within a surface, and not past its edge, is what has surface on all sides so far away.
constexpr double kInsideM = 0.15;
constexpr double kFitsM = 0.1;
constexpr double kOffMapM = 0.15;  // this far from all map points is off its surfaces
// Standard deviations that the share of contradicting points, told from some of them, must stay
// below its limit by.
constexpr double kSure = 2;
// Rays that graze a thick surface pass through points of it: at the right place in a map of scans
// up to an eighth of them.
constexpr double kMaxBlocked = 0.15;
constexpr double kRefuted = 2, kRefutedBlocked = 0.2;  // times what may contradict; rays
// Another place has things that this one has not, and lacks others: with the building's other
// storeys at least 0.5 % of the rays pass through these. What a survey did not see only adds.
constexpr double kNothingGone = 0.004;
constexpr double kUnseen = 1.5;         // times what may contradict, then
constexpr double kThroughCosine = 0.5;  // flatter rays glide along a surface

PriorMap::Nearest nearestTo(const PriorMap& map, const Vec3& at, double within_m) {
  return map.nearest(
      {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())},
      static_cast<float>(within_m));
}

// Whether a ray through `at` crosses a surface less than half a step from there, well inside it.
bool passesThrough(const PriorMap& map, const Vec3& at, const Vec3& direction) {
  const PriorMap::Nearest nearest = nearestTo(map, at, kRayStepM / 2 + kOnMapM);
  if (!nearest.found()) return false;
  const MapPlane plane = map.plane(nearest.index);
  const Vec3 normal(static_cast<double>(plane.nx), static_cast<double>(plane.ny),
                    static_cast<double>(plane.nz));
  const double cosine = normal.dot(direction);
  if (!plane.planar() || std::abs(cosine) < kThroughCosine) return false;
  const Point3f p = map.point(nearest.index);
  const Vec3 to_plane =
      Vec3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)) - at;
  const double along = (normal.dot(to_plane) + static_cast<double>(plane.offset_m)) / cosine;
  if (std::abs(along) > kRayStepM / 2) return false;
  const Vec3 crossing = at + along * direction;
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  for (const Vec3& aside : {Vec3(Vec3::Zero()), Vec3(u), Vec3(-u), Vec3(v), Vec3(-v)}) {
    if (!nearestTo(map, crossing + kInsideM * aside, kOnMapM).found()) return false;
  }
  return true;
}

// The share of rays that meet the map on the way to their end: at the right pose, next to none.
double blockedShare(const PriorMap& map, const std::vector<Point3f>& points_body,
                    const Vec3& sensor_body, const Pose& pose) {
  const Vec3 from = pose * sensor_body;
  std::size_t rays = 0, blocked = 0;
  for (const Point3f& p : points_body) {
    const Vec3 to =
        pose * Vec3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    const double length = (to - from).norm();
    if (length < 2 * kRayMarginM) continue;
    ++rays;
    const Vec3 direction = (to - from) / length;
    const int steps = static_cast<int>(std::ceil((length - 2 * kRayMarginM) / kRayStepM));
    for (int step = 0; step < steps; ++step) {
      if (!passesThrough(map, from + (kRayMarginM + step * kRayStepM) * direction, direction)) {
        continue;
      }
      ++blocked;
      break;
    }
  }
  return rays == 0 ? 0 : static_cast<double>(blocked) / static_cast<double>(rays);
}

// The share of points off all surfaces where the survey would have seen one: at the right pose,
// what has come since, and what the survey saw from one side only.
double contradictedShare(const PriorMap& map, const std::vector<Point3f>& points_body,
                         const Pose& pose) {
  const MapCoverage coverage(map, Vec3::UnitZ());
  std::size_t contradicted = 0;
  for (const Point3f& p : points_body) {
    const Vec3 at = pose * toVec(p);
    contradicted += !nearestTo(map, at, kOffMapM).found() && coverage.hasGroundBelow(at) ? 1U : 0U;
  }
  return static_cast<double>(contradicted) /
         static_cast<double>(std::max<std::size_t>(points_body.size(), 1));
}

// No larger, surely, than that, as one share of many rays.
double surelyAtMost(double share, std::size_t rays) {
  const auto count = static_cast<double>(std::max<std::size_t>(rays, 1));
  return share + kSure * std::sqrt(std::max(share, 1 / count) / count);
}

// Whether what contradicts may be what the survey did not see: the far side of a cupboard, a
// shadow.
bool mayBeUnseen(const StartEvidence& evidence, const MatcherSettings& settings) {
  return surelyAtMost(evidence.blocked, evidence.rays) < kNothingGone &&
         surelyAtMost(evidence.contradicted, evidence.rays) <
             kUnseen * settings.start_max_contradicted;
}

}  // namespace

MatchRefusal judgeStart(const StartEvidence& evidence, const MatcherSettings& settings) {
  if (evidence.explained < settings.start_min_explained ||
      evidence.fitting < settings.locate_min_inlier_share) {
    return MatchRefusal::kNotVerified;
  }
  const bool contradicts =
      surelyAtMost(evidence.contradicted, evidence.rays) > settings.start_max_contradicted;
  return contradicts || evidence.blocked > kMaxBlocked ? MatchRefusal::kMapContradicts
                                                       : MatchRefusal::kNone;
}

MatchRefusal verifyStart(const Registration& registration, const Alignment& alignment,
                         const PriorMap& map, const MatcherSettings& settings,
                         StartEvidence& evidence) {
  const MatchRefusal refusal = judgeStart(evidence, settings);
  if (refusal != MatchRefusal::kMapContradicts || isRefuted(evidence, settings)) return refusal;
  const StartEvidence whole =
      weighStart(registration, alignment, map, registration.points().size());
  if (!mayBeUnseen(whole, settings)) return refusal;
  evidence = whole;
  return MatchRefusal::kNone;
}

bool isRefuted(const StartEvidence& evidence, const MatcherSettings& settings) {
  return evidence.contradicted > kRefuted * settings.start_max_contradicted ||
         evidence.blocked > kRefutedBlocked;
}

StartEvidence weighStart(const Registration& registration, const Alignment& alignment,
                         const PriorMap& map, std::size_t rays) {
  int fitting = 0;
  for (const PlaneRow& row : registration.rows()) fitting += std::abs(row.residual) < kFitsM;
  const int tried = static_cast<int>(registration.points().size());
  const int undecided = alignment.near - alignment.matched;
  StartEvidence evidence;
  evidence.explained = fitting / std::max(1.0, 1.0 * (tried - undecided));
  evidence.fitting = fitting / std::max(1.0, 1.0 * alignment.matched);
  const std::vector<Point3f> some = registration.averaged().everyNth(rays).points;
  evidence.blocked = blockedShare(map, some, registration.sensorPosition(), alignment.T_local_body);
  evidence.rays = some.size();
  evidence.contradicted = contradictedShare(map, some, alignment.T_local_body);
  return evidence;
}

}  // namespace paloc
