#pragma once

#include <string>
#include <vector>

#include "paloc/core/trajectory.h"

namespace paloc {

/// Follows which directions the map leaves open or weak from scan to scan, and tells when one is
/// lost and when it is back. A direction is followed by its axis in the map: in a corridor the axis
/// stays, while the body that looks about has another name for it every second. What is lost, or
/// back, for less than half a second is not told. Scans without a map factor say nothing.
class DirectionWatch {
 public:
  /// What the next frame made known, a sentence each, with the time since the first frame:
  /// "12.3 s: the map no longer fixes the position along body x (heading)".
  std::vector<std::string> add(const FrameDiagnostics& frame);

 private:
  struct Lost {
    bool rotation = false;
    Vec3 axis_map = Vec3::Zero();  // as last seen
    std::string name;              // as first seen
    TimeNs since_ns = 0, last_ns = 0;
    bool told = false;
  };

  void take(const MatchDirection& direction, bool rotation, const Mat3& R_map_body, TimeNs t_ns);
  std::string timeText(TimeNs t_ns) const;

  std::vector<Lost> lost_;
  TimeNs first_ns_ = 0;
  bool begun_ = false;
};

}  // namespace paloc
