#pragma once

#include <cstddef>

namespace paloc {

/// Eight points that follow each other on the Hilbert curve, their coordinates side by side. What
/// is missing in the last block lies too far away to be found.
struct PointBlock {
  static constexpr std::size_t kPoints = 8;
  static constexpr float kMissing = 1e30F;
  float x[kPoints], y[kPoints], z[kPoints];
};
static_assert(sizeof(PointBlock) == 96);

}  // namespace paloc
