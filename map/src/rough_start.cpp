#include "rough_start.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace paloc {
namespace {

constexpr std::size_t kCoarsePoints = 800;
constexpr std::size_t kRays = 300;
constexpr double kRayStepM = 0.2;
constexpr double kRayMarginM = 0.5;  // before the end of a ray: that surface may be a little nearer
constexpr double kBlockRadiusM = 0.08;  // a ray this near to a map point passes through its surface
constexpr double kFitsM = 0.1;
constexpr double kGoodShare =
    0.9;  // of all matched, and of all matchable: no further start is tried

Pose turned(const Pose& pose, double yaw) {
  return {pose.position, so3::exp(Vec3(0, 0, yaw)) * pose.rotation};
}

// Starts about the rough pose: turned about the vertical, moved in the horizontal plane.
std::vector<Pose> startsAround(const Pose& rough) {
  std::vector<Pose> starts{rough};
  constexpr double kTurn = 0.12, kMove = 0.6;
  for (double yaw : {kTurn, -kTurn}) starts.push_back(turned(rough, yaw));
  for (double yaw : {0.0, kTurn, -kTurn}) {
    for (const Vec3& move : {Vec3(kMove, 0, 0), Vec3(-kMove, 0, 0), Vec3(0, kMove, 0),
                             Vec3(0, -kMove, 0), Vec3(0, 0, kMove), Vec3(0, 0, -kMove)}) {
      Pose start = turned(rough, yaw);
      start.position += move;
      starts.push_back(start);
    }
  }
  return starts;
}

int fittingPoints(const Registration& registration) {
  int fitting = 0;
  for (const PlaneRow& row : registration.rows()) fitting += std::abs(row.residual) < kFitsM;
  return fitting;
}

std::vector<Point3f> everyNth(const std::vector<Point3f>& points, std::size_t count) {
  const std::size_t step = std::max<std::size_t>(points.size() / count, 1);
  std::vector<Point3f> some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

// The share of rays that meet the map on the way to their end: at the right pose, next to none.
double blockedShare(const PriorMap& map, const std::vector<Point3f>& points_body,
                    const Vec3& sensor_body, const Pose& pose) {
  const Vec3 from = pose * sensor_body;
  std::size_t rays = 0, blocked = 0;
  for (const Point3f& p : everyNth(points_body, kRays)) {
    const Vec3 to =
        pose * Vec3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    const double length = (to - from).norm();
    if (length < 2 * kRayMarginM) continue;
    ++rays;
    const Vec3 direction = (to - from) / length;
    const int steps = static_cast<int>(std::ceil((length - 2 * kRayMarginM) / kRayStepM));
    for (int step = 0; step < steps; ++step) {
      const double along = kRayMarginM + step * kRayStepM;
      const Vec3 at = from + along * direction;
      const Point3f query{static_cast<float>(at.x()), static_cast<float>(at.y()),
                          static_cast<float>(at.z())};
      const PriorMap::Nearest nearest = map.nearest(query, static_cast<float>(kBlockRadiusM));
      if (!nearest.found()) continue;
      // A ray that glides along a floor or wall comes near to it and does not pass through.
      const MapPlane plane = map.plane(nearest.index);
      const Vec3 normal(static_cast<double>(plane.nx), static_cast<double>(plane.ny),
                        static_cast<double>(plane.nz));
      if (!plane.planar() || std::abs(normal.dot(direction)) < 0.5) continue;
      ++blocked;
      break;
    }
  }
  return rays == 0 ? 0 : static_cast<double>(blocked) / static_cast<double>(rays);
}

}  // namespace

RoughStart searchAround(Registration& registration, const PriorMap& map,
                        const MatcherSettings& settings, const Pose& rough) {
  const std::vector<Point3f> all = registration.points();
  const Vec3 sensor = registration.sensorPosition();
  const AlignSchedule wide{.first_gate_m = settings.locate_distance_m,
                           .first_iterations = 6,
                           .gate_m = settings.max_distance_m,
                           .max_iterations = 14,
                           .shared_errors = false};
  registration.setPoints(everyNth(all, kCoarsePoints), sensor);
  Pose best = rough;
  int most = -1;
  for (const Pose& start : startsAround(rough)) {
    const Alignment coarse = registration.align(start, wide);
    const int fitting = fittingPoints(registration);
    if (fitting > most) most = fitting, best = coarse.T_local_body;
    if (fitting > kGoodShare * coarse.matched &&
        coarse.near > kGoodShare * static_cast<double>(registration.points().size())) {
      break;
    }
  }
  registration.setPoints(all, sensor);
  RoughStart found;
  found.alignment = registration.align(
      best, {.first_gate_m = settings.max_distance_m,
             .gate_m = std::min(settings.fine_distance_m, settings.max_distance_m),
             .max_iterations = settings.max_iterations});
  found.fitting_share = fittingPoints(registration) / std::max(1.0, 1.0 * found.alignment.matched);
  found.blocked_share = blockedShare(map, all, sensor, found.alignment.T_local_body);
  found.verified = found.fitting_share >= settings.locate_min_inlier_share &&
                   found.blocked_share <= settings.locate_max_blocked_share;
  return found;
}

}  // namespace paloc
