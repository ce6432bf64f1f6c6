#pragma once

#include <mrpt/poses/CPose3D.h>

#include <optional>

#include "paloc/core/types.h"

namespace paloc {

/// What is known of the body's pose when a scan is to be found in the map. Nothing set: it may be
/// anywhere. A pose outdoes a position.
struct StartGuess {
  static StartGuess near(const mrpt::poses::CPose3D& T_map_body) {
    StartGuess guess;
    guess.T_map_body = T_map_body;
    return guess;
  }

  /// The pose, roughly.
  std::optional<mrpt::poses::CPose3D> T_map_body = {};
  /// The position alone (m, map frame): the heading may be any.
  std::optional<Vec3> position_map = {};
  /// Unit vector that points up, in the body frame, from the IMU. Without it the tilt is told from
  /// the scan's own surfaces; it must then be as the rough pose has it, or none, to 20 degrees.
  std::optional<Vec3> up_body = {};
  /// Whether the surroundings of a rough pose are searched where registration from it is refused.
  bool search_around = true;
};

}  // namespace paloc
