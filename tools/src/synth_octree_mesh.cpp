#include <algorithm>
#include <array>
#include <unordered_map>

#include "paloc/tools/synth_map_scene.h"

namespace paloc::synth {
namespace {

using Cell = OctreeMap::Cell;

constexpr float kReflectivity = 0.5F;

/// The corners of cells, each once, and which faces meet there.
class Corners {
 public:
  std::uint32_t at(const Cell& corner, int face) {
    const auto [entry, fresh] =
        numbers_.try_emplace(keyOf(corner), static_cast<std::uint32_t>(corners_.size()));
    if (fresh) corners_.push_back({corner, 0});
    corners_[entry->second].faces |= 1U << static_cast<unsigned>(face);
    return entry->second;
  }

  std::vector<Point3f> moved(double cell_m) const {
    std::vector<Point3f> points;
    points.reserve(corners_.size());
    for (const Corner& corner : corners_) {
      Vec3 p(corner.at[0], corner.at[1], corner.at[2]);
      for (int face = 0; face < 6; ++face) {
        if ((corner.faces >> static_cast<unsigned>(face) & 1U) == 0) continue;
        p[face / 2] += face % 2 == 0 ? 0.5 : -0.5;
      }
      p *= cell_m;
      points.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
    return points;
  }

 private:
  struct Corner {
    Cell at;
    unsigned faces;
  };

  static std::uint64_t keyOf(const Cell& corner) {
    const auto bits = [](int i) { return static_cast<std::uint64_t>(i + (1 << 16)); };
    return bits(corner[0]) << 40 | bits(corner[1]) << 20 | bits(corner[2]);
  }

  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
  std::vector<Corner> corners_;
};

}  // namespace

SceneMesh meshOf(const OctreeMap& map) {
  SceneMesh mesh;
  mesh.surface_reflectivity = {kReflectivity};
  Corners corners;
  map.forEachPatch([&](const OctreeMap::Patch& patch) {
    const std::size_t across = static_cast<std::size_t>(patch.face) / 2;
    const std::size_t u = (across + 1) % 3, v = (across + 2) % 3;
    forEachCell(patch, [&](const Cell& cell) {
      std::array<std::uint32_t, 4> quad{};
      for (unsigned i = 0; i < 4; ++i) {
        Cell corner = cell;
        if (patch.face % 2 == 1) ++corner[across];
        if (i == 1 || i == 2) ++corner[u];
        if (i >= 2) ++corner[v];
        quad[i] = corners.at(corner, patch.face);
      }
      mesh.triangles.push_back({quad[0], quad[1], quad[2]});
      mesh.triangles.push_back({quad[0], quad[2], quad[3]});
    });
  });
  mesh.vertices = corners.moved(map.resolution());
  mesh.triangle_surface.assign(mesh.triangles.size(), 0);
  return mesh;
}

}  // namespace paloc::synth
