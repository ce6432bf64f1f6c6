#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "paloc/core/types.h"

namespace paloc {

/// Number of the cubic voxel of a given edge (m) that a point lies in: 21 bits an axis, x first, so
/// that the 64th bit is free. Nothing for points further from zero than 2^20 voxels.
inline constexpr int kVoxelBits = 21;
inline constexpr double kVoxelLimit = 1 << (kVoxelBits - 1);
inline constexpr std::uint64_t kVoxelAxisMask = (std::uint64_t{1} << kVoxelBits) - 1;

inline std::optional<std::uint64_t> voxelKeyOf(const Vec3& point, double edge_m) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double index = std::floor(point[axis] / edge_m) + kVoxelLimit;
    if (!(index >= 0 && index < 2 * kVoxelLimit)) return std::nullopt;
    key = key << kVoxelBits | static_cast<std::uint64_t>(index);
  }
  return key;
}

/// The middle of a voxel (m).
inline Vec3 voxelCentre(std::uint64_t key, double edge_m) {
  const auto along = [&](int shift) {
    return (static_cast<double>(key >> shift & kVoxelAxisMask) - kVoxelLimit + 0.5) * edge_m;
  };
  return {along(2 * kVoxelBits), along(kVoxelBits), along(0)};
}

}  // namespace paloc
