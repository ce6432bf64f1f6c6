#pragma once

#include <cstddef>

#include "paloc/core/types.h"

namespace paloc {

/// Eight points that follow each other on the Hilbert curve, their coordinates side by side. What
/// is missing in the last block lies too far away to be found.
struct PointBlock {
  static constexpr std::size_t kPoints = 8;
  static constexpr float kMissing = 1e30F;
  float x[kPoints], y[kPoints], z[kPoints];
};
static_assert(sizeof(PointBlock) == 96);

/// The `i`-th point of many blocks.
inline Point3f pointAt(const PointBlock* blocks, std::size_t i) {
  const PointBlock& block = blocks[i / PointBlock::kPoints];
  const std::size_t lane = i % PointBlock::kPoints;
  return {block.x[lane], block.y[lane], block.z[lane]};
}

}  // namespace paloc
