#include "paloc/tools/direction_watch.h"

#include <cmath>
#include <cstdio>

#include "paloc/core/direction_name.h"
#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

constexpr double kSettle_s = 0.5;
// The same direction of the map: within 37 degrees of where it was one scan ago. Three directions
// of a kind are at right angles, so none is taken for another.
constexpr double kSameAxisCosine = 0.8;

std::string whatOf(bool rotation, const std::string& name) {
  return (rotation ? "the rotation " : "the position ") + name;
}

}  // namespace

std::string DirectionWatch::timeText(TimeNs t_ns) const {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.1f s: ", secondsBetween(first_ns_, t_ns));
  return buffer;
}

void DirectionWatch::take(const MatchDirection& direction, bool rotation, const Mat3& R_map_body,
                          TimeNs t_ns) {
  const Vec3 axis_map = R_map_body * direction.axis_body;
  for (Lost& lost : lost_) {
    if (lost.rotation != rotation || std::abs(lost.axis_map.dot(axis_map)) < kSameAxisCosine) {
      continue;
    }
    lost.axis_map = axis_map;
    lost.last_ns = t_ns;
    return;
  }
  lost_.push_back(
      {rotation, axis_map, directionName(direction.axis_body, rotation), t_ns, t_ns, false});
}

std::vector<std::string> DirectionWatch::add(const FrameDiagnostics& frame) {
  std::vector<std::string> told;
  if (!begun_) first_ns_ = frame.t_ns;
  begun_ = true;
  if (!frame.match.accepted()) return told;
  const Mat3 R_map_body = fromMrpt(frame.match.T_map_body).rotation;
  for (std::size_t k = 0; k < 6; ++k) {
    const MatchDirection& direction = frame.match.directions[k];
    if (direction.cls != DirectionClass::kFull) take(direction, k >= 3, R_map_body, frame.t_ns);
  }
  for (Lost& lost : lost_) {
    if (lost.told || secondsBetween(lost.since_ns, lost.last_ns) < kSettle_s) continue;
    lost.told = true;
    told.push_back(timeText(lost.since_ns) + "the map no longer fixes " +
                   whatOf(lost.rotation, lost.name));
  }
  std::erase_if(lost_, [&](const Lost& lost) {
    if (secondsBetween(lost.last_ns, frame.t_ns) < kSettle_s) return false;
    if (!lost.told) return true;
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, " again, after %.1f s",
                  secondsBetween(lost.since_ns, lost.last_ns));
    told.push_back(timeText(lost.last_ns) + "the map fixes " + whatOf(lost.rotation, lost.name) +
                   buffer);
    return true;
  });
  return told;
}

}  // namespace paloc
