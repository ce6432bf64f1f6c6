#include "rough_start.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace paloc {
namespace {

constexpr std::size_t kCoarsePoints = 800;
constexpr std::size_t kRays = 600;
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

}  // namespace

RoughStart searchAround(Registration& registration, const PriorMap& map,
                        const MatcherSettings& settings, const Pose& rough) {
  const AveragedPoints all = registration.averaged();
  const Vec3 sensor = registration.sensorPosition();
  const AlignSchedule wide{.first_gate_m = settings.locate_distance_m,
                           .first_iterations = 6,
                           .gate_m = settings.max_distance_m,
                           .max_iterations = 14};
  registration.setPoints(all.everyNth(kCoarsePoints), sensor);
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
  found.evidence = weighStart(registration, found.alignment, map, kRays);
  found.refusal = verifyStart(registration, found.alignment, map, settings, found.evidence);
  return found;
}

}  // namespace paloc
