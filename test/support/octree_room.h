#pragma once

#include <octomap/OcTree.h>

#include <cmath>
#include <filesystem>

namespace paloc::test {

/// Writes an OctoMap of an empty room, length x width x height m (z up, a corner of the inside at
/// zero): occupied cells one layer thick about known free space.
inline void writeRoom(const std::filesystem::path& file, double cell_m, double length_m,
                      double width_m, double height_m) {
  octomap::OcTree tree(cell_m);
  const auto cells = [cell_m](double length) {
    return static_cast<int>(std::lround(length / cell_m));
  };
  const int x_end = cells(length_m), y_end = cells(width_m), z_end = cells(height_m);
  const auto key = [](int i) { return static_cast<octomap::key_type>(32768 + i); };
  for (int x = -1; x <= x_end; ++x) {
    for (int y = -1; y <= y_end; ++y) {
      for (int z = -1; z <= z_end; ++z) {
        const bool wall = x < 0 || y < 0 || z < 0 || x == x_end || y == y_end || z == z_end;
        tree.setNodeValue(octomap::OcTreeKey(key(x), key(y), key(z)), wall ? 2.0F : -1.0F, true);
      }
    }
  }
  tree.updateInnerOccupancy();
  tree.prune();
  tree.writeBinary(file.string());
}

}  // namespace paloc::test
