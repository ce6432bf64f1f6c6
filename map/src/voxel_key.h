#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace paloc {

inline constexpr int kVoxelBits = 21;  ///< an axis: three of them fit in 64 bits
inline constexpr double kVoxelLimit = 1 << (kVoxelBits - 1);

/// The number of the voxel along one axis, shifted to be positive; saturates. Shifted first, so
/// that cutting off the fraction rounds down: std::floor is a call on plain x86-64.
inline std::uint64_t voxelIndex(float coordinate, double inverse_voxel) {
  const double shifted = static_cast<double>(coordinate) * inverse_voxel + kVoxelLimit;
  const double bounded = std::min(std::max(shifted, 0.0), 2 * kVoxelLimit - 1);
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(bounded));
}

/// Spreads the low 21 bits of a number, two zeros between each.
inline std::uint64_t spreadBits(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

/// Mixes the bits of a key for a hash table whose size is a power of two (Fibonacci hashing).
inline std::uint64_t hashKey(std::uint64_t key) {
  key ^= key >> 32;
  key *= 0x9e3779b97f4a7c15ULL;
  return key ^ key >> 29;
}

}  // namespace paloc
