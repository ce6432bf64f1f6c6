#pragma once

#include <mrpt/poses/CPose3D.h>

#include <string>

#include "paloc/core/types.h"

namespace paloc {

/// A pose as the command line gives it, "x,y,z,yaw,pitch,roll" in m and degrees (rotation
/// Rz(yaw) Ry(pitch) Rx(roll)). Throws UsageError, naming `option`, on anything else.
mrpt::poses::CPose3D parsePose(const std::string& text, const std::string& option);

/// Likewise a position, "x,y,z" in m.
Vec3 parsePosition(const std::string& text, const std::string& option);

}  // namespace paloc
