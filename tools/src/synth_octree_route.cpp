#include <algorithm>
#include <cmath>
#include <map>

#include "paloc/core/errors.h"
#include "paloc/tools/free_level.h"
#include "paloc/tools/synth_map_scene.h"
#include "paloc/tools/synth_walk.h"

namespace paloc::synth {
namespace {

// Half a metre, and what the body sways and corners are rounded by.
constexpr double kClearance_m = 0.65;
constexpr double kLowest_m = 0.8, kHighest_m = 1.9;  // of the body above the floor
constexpr double kSide_m = 0.4;                      // out and back keep to their right by that
constexpr double kLeast_m = 5, kCornerStep_m = 1;

/// The layer of the floor: that with the most area seen from above.
int floorLayer(const OctreeMap& map) {
  std::map<int, std::int64_t> area;
  constexpr int kUp = 5;
  map.forEachPatch([&](const OctreeMap::Patch& patch) {
    if (patch.face != kUp || patch.beyond != OctreeMap::State::kFree) return;
    area[patch.low[2]] += std::int64_t{patch.edge} * patch.edge;
  });
  if (area.empty()) throw UsageError("--map: no floor was found in it; give a --trajectory");
  return std::max_element(area.begin(), area.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

struct Level {
  int layer = 0;
  FreeLevel free;
};

/// The layer with the most room, near the height of a chest where it makes no great difference.
Level roomiestLevel(const OctreeMap& map) {
  const int floor = floorLayer(map);
  const int lowest = floor + static_cast<int>(std::ceil(kLowest_m / map.resolution()));
  const int highest = floor + static_cast<int>(kHighest_m / map.resolution());
  const int step = std::max(1, static_cast<int>(0.2 / map.resolution()));
  std::vector<Level> levels;
  for (int layer = lowest; layer <= highest; layer += step) {
    levels.push_back({layer, FreeLevel(map, layer, kClearance_m)});
  }
  const auto worth = [&](const Level& level) {
    const double off = std::abs((level.layer - floor) * map.resolution() - kCarryHeight_m);
    return static_cast<double>(level.free.size()) / (1 + off);
  };
  return *std::max_element(levels.begin(), levels.end(),
                           [&](const Level& a, const Level& b) { return worth(a) < worth(b); });
}

/// The way there and back, each on its right-hand side as far as there is room.
class OutAndBack {
 public:
  OutAndBack(const OctreeMap& map, const Level& level) : map_(map), level_(level) {}

  std::vector<Vec3> corners(std::vector<FreeLevel::Place> way) const {
    std::vector<Vec3> line;
    for (const auto& place : way) line.push_back(map_.centre({place.x, place.y, level_.layer}));
    line = smoothed(line);
    std::vector<Vec3> corners = toTheRight(line);
    std::reverse(line.begin(), line.end());
    const std::vector<Vec3> back = toTheRight(line);
    corners.insert(corners.end(), back.begin(), back.end());
    for (Vec3& corner : corners) corner.z() -= kCarryHeight_m;
    return corners;
  }

 private:
  // The way along the grid has steps: a mean over a metre has none.
  std::vector<Vec3> smoothed(const std::vector<Vec3>& line) const {
    const auto reach = static_cast<std::ptrdiff_t>(0.5 / map_.resolution());
    const auto size = static_cast<std::ptrdiff_t>(line.size());
    std::vector<Vec3> result;
    for (std::ptrdiff_t i = 0; i < size; ++i) {
      const std::ptrdiff_t here = std::min({reach, i, size - 1 - i});
      Vec3 sum = Vec3::Zero();
      for (std::ptrdiff_t k = i - here; k <= i + here; ++k)
        sum += line[static_cast<std::size_t>(k)];
      result.push_back(sum / static_cast<double>(2 * here + 1));
    }
    return result;
  }

  std::vector<Vec3> toTheRight(const std::vector<Vec3>& line) const {
    const auto stride = static_cast<std::size_t>(std::max(1.0, kCornerStep_m / map_.resolution()));
    std::vector<Vec3> corners;
    for (std::size_t i = 0; i < line.size(); i += stride) {
      const std::size_t from = i >= stride ? i - stride : 0;
      const std::size_t to = std::min(i + stride, line.size() - 1);
      const Vec3 ahead = (line[to] - line[from]).normalized();
      const Vec3 right(ahead.y(), -ahead.x(), 0);
      double side = kSide_m;
      while (side > 0 && !clearAt(line[i] + side * right)) side -= 0.1;
      corners.push_back(line[i] + std::max(side, 0.0) * right);
    }
    return corners;
  }

  bool clearAt(const Vec3& p) const {
    const OctreeMap::Cell cell = map_.cellOf(p);
    return level_.free.clear({cell[0], cell[1]});
  }

  const OctreeMap& map_;
  const Level& level_;
};

}  // namespace

std::vector<Vec3> routeThrough(const OctreeMap& map) {
  const Level level = roomiestLevel(map);
  auto way = level.free.longestWay();
  if (static_cast<double>(way.size()) * map.resolution() < kLeast_m) {
    throw UsageError(
        "--map: no way of 5 m was found in its free space that keeps half a metre clear of what is "
        "occupied; give a --trajectory");
  }
  return OutAndBack(map, level).corners(std::move(way));
}

Scene makeMapScene(const std::filesystem::path& file, bool with_route) {
  const OctreeMap map = OctreeMap::load(file);
  Scene scene;
  scene.name = file.filename().string();
  scene.description = "The occupied cells of the OctoMap file " + scene.name + ".";
  scene.mesh = meshOf(map);
  if (scene.mesh.triangles.empty()) throw IoError(file.string() + ": holds nothing occupied");
  if (with_route) scene.route = routeThrough(map);
  return scene;
}

}  // namespace paloc::synth
