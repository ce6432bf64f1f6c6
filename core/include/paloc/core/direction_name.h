#pragma once

#include <string>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// A direction of the pose in plain words, from its axis (unit vector, body frame; its sign does
/// not matter): "along body x (heading)", "along body y (sideways)", "along body z (height)", or
/// "roll", "pitch", "yaw", where the axis lies within 20 degrees of a body axis. One that leans is
/// named by all that it has a share of (a component of 0.24), with signs: "diagonal along body
/// +x-y", "diagonal about body +x+z". Empty for an axis that is none. Without commas.
PALOC_EXPORT std::string directionName(const Vec3& axis_body, bool rotation);

}  // namespace paloc
