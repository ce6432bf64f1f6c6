#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "paloc/core/export.h"

namespace paloc {

/// The Hilbert curve through 2^bits voxels an axis. Voxels that follow each other on it touch:
/// points in this order lie in compact groups, however these are cut.
///
/// From the largest cube to the smallest, the curve goes through the eight halves of a cube in the
/// order of a Gray code, and within each half axes are exchanged and inverted (J. Skilling,
/// "Programming the Hilbert curve", 2004). How they are is one of a few states, so that a table of
/// state and half gives the place in the cube and the next state; this one takes two cubes at a
/// time.
class PALOC_EXPORT HilbertCurve {
 public:
  HilbertCurve();

  /// Place of a voxel on the curve; its numbers have `bits` bits, at most 21.
  std::uint64_t place(std::uint32_t x, std::uint32_t y, std::uint32_t z, int bits) const;

 private:
  /// Places within the cube, and the state within the part that was entered.
  struct Entry {
    std::uint8_t place, state;
  };
  std::vector<std::array<Entry, 8>> one_;   // by state and half
  std::vector<std::array<Entry, 64>> two_;  // by state, half, and half of the half
};

}  // namespace paloc
