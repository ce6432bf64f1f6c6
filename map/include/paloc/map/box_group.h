#pragma once

#include <cstddef>

namespace paloc {

/// Bounding boxes of eight blocks of points, or of eight such groups, side by side (m); what is
/// missing lies far away.
struct BoxGroup {
  static constexpr std::size_t kBoxes = 8;
  float low[3][kBoxes], high[3][kBoxes];  // x, y, z
};

}  // namespace paloc
