#include "paloc/tools/synth_changed_scene.h"

#include <algorithm>
#include <cmath>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/tools/synth_added_boxes.h"

namespace paloc::synth {
namespace {

constexpr float kClothing = 0.35F, kGlass = 0.4F;  // reflectivity

Vec3 toVec(const Point3f& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

std::uint32_t newSurface(SceneMesh& mesh, float reflectivity) {
  mesh.surface_reflectivity.push_back(reflectivity);
  return static_cast<std::uint32_t>(mesh.surfaces() - 1);
}

/// Applies changes one by one.
class Changer {
 public:
  Changer(const Scene& scene, const Motion& motion, const Raycaster& raycaster)
      : scene_(scene), motion_(motion), raycaster_(raycaster) {
    result_.mesh = scene.mesh;
  }

  void apply(const Change& change) {
    switch (change.kind) {
      case ChangeKind::kMovedWall:
        return moveWall(change);
      case ChangeKind::kRemovedFurniture:
        return removeFurniture(change);
      case ChangeKind::kAddedBox:
        return addBoxes(change);
      case ChangeKind::kWalkingPeople:
        result_.people = WalkingPeople(count(change, 4), motion_, raycaster_);
        result_.people_surface = newSurface(result_.mesh, kClothing);
        return;
      case ChangeKind::kGlass:
        needs(!scene_.changeables.panes.empty(), change);
        result_.panes = scene_.changeables.panes;
        result_.glass_surface = newSurface(result_.mesh, kGlass);
        return;
      case ChangeKind::kMissingPart:
        return cutMap(change);
    }
  }

  ChangedScene take() { return std::move(result_); }

 private:
  void needs(bool condition, const Change& change) const {
    if (!condition) {
      throw UsageError(
          text("--change: the scene ", scene_.name, " has nothing for ", toString(change.kind)));
    }
  }

  static std::size_t count(const Change& change, double otherwise) {
    const double value = change.value(0, otherwise);
    if (value < 1 || value > 100 || value != std::floor(value)) {
      throw UsageError(text("--change: ", toString(change.kind), " takes a count from 1 to 100"));
    }
    return static_cast<std::size_t>(value);
  }

  std::vector<std::size_t> trianglesIn(const Region& region) const {
    std::vector<std::size_t> inside;
    for (std::size_t i = 0; i < result_.mesh.triangles.size(); ++i) {
      const auto& corners = result_.mesh.triangles[i];
      if (std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
            return region.contains(toVec(result_.mesh.vertices[v]));
          })) {
        inside.push_back(i);
      }
    }
    return inside;
  }

  /// The boxes about the triangles of each body: a wall and what hangs on it are told apart by
  /// their surfaces only, so one box holds all.
  OrientedBox boxAbout(const std::vector<std::size_t>& triangles) const {
    OrientedBox box{{}, Vec3::Constant(1e9), Vec3::Constant(-1e9)};
    for (const std::size_t t : triangles) {
      for (const std::uint32_t v : result_.mesh.triangles[t]) {
        box.low = box.low.cwiseMin(toVec(result_.mesh.vertices[v]));
        box.high = box.high.cwiseMax(toVec(result_.mesh.vertices[v]));
      }
    }
    return box;
  }

  void moveWall(const Change& change) {
    const auto& walls = scene_.changeables.walls;
    needs(!walls.empty(), change);
    const double index = change.value(1, 0);
    if (!(index >= 0 && index < static_cast<double>(walls.size()) && index == std::floor(index))) {
      throw UsageError(text("--change: the scene ", scene_.name, " has ", walls.size(),
                            " walls to be moved, counted from 0"));
    }
    const MovableWall& wall = walls[static_cast<std::size_t>(index)];
    const Vec3 by = change.value(0, 0.3) * wall.direction;
    const std::vector<std::size_t> triangles = trianglesIn(wall.region);
    ChangedObject object{toString(change.kind), wall.name, {boxAbout(triangles)}, {}};
    std::vector<std::uint32_t> vertices;
    for (const std::size_t t : triangles) {
      vertices.insert(vertices.end(), result_.mesh.triangles[t].begin(),
                      result_.mesh.triangles[t].end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const std::uint32_t v : vertices) {
      Point3f& p = result_.mesh.vertices[v];
      const Vec3 moved = toVec(p) + by;
      p = {static_cast<float>(moved.x()), static_cast<float>(moved.y()),
           static_cast<float>(moved.z())};
    }
    object.added = {boxAbout(triangles)};
    result_.objects.push_back(std::move(object));
  }

  void removeFurniture(const Change& change) {
    const auto& all = scene_.changeables.furniture;
    needs(!all.empty(), change);
    const std::size_t most = count(change, static_cast<double>(all.size()));
    for (std::size_t i = 0; i < std::min(most, all.size()); ++i) {
      const std::vector<std::size_t> triangles = trianglesIn(all[i].region);
      result_.objects.push_back({toString(change.kind), all[i].name, {boxAbout(triangles)}, {}});
      auto& mesh = result_.mesh;
      for (auto t = triangles.rbegin(); t != triangles.rend(); ++t) {
        mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(*t));
        mesh.triangle_surface.erase(mesh.triangle_surface.begin() +
                                    static_cast<std::ptrdiff_t>(*t));
      }
    }
  }

  void addBoxes(const Change& change) {
    const std::size_t wanted = count(change, 3);
    const std::vector<OrientedBox> boxes = placesForBoxes(wanted, motion_, raycaster_);
    if (boxes.size() < wanted) {
      throw UsageError(text("--change: beside the way there is room for ", boxes.size(),
                            " boxes, not for ", wanted));
    }
    for (const OrientedBox& box : boxes) {
      addBox(result_.mesh, box);
      result_.objects.push_back(
          {toString(change.kind), text("box ", result_.objects.size() + 1), {}, {box}});
    }
  }

  void cutMap(const Change& change) {
    if (change.values.empty()) {
      needs(!scene_.changeables.missing.empty(), change);
      result_.missing.push_back(scene_.changeables.missing.front());
      return;
    }
    constexpr double kFar = 1e6;  // m: all heights
    const auto& v = change.values;
    if (!(v[0] < v[1] && v[2] < v[3])) {
      throw UsageError("--change: missing-part takes from < to along x, then along y");
    }
    result_.missing.push_back({{v[0], v[2], -kFar}, {v[1], v[3], kFar}});
  }

  const Scene& scene_;
  const Motion& motion_;
  const Raycaster& raycaster_;
  ChangedScene result_;
};

}  // namespace

Surroundings ChangedScene::surroundings(const Raycaster& raycaster) const {
  Surroundings all(raycaster);
  all.people = people;
  all.people_surface = people_surface;
  all.panes = panes;
  all.glass_surface = glass_surface;
  return all;
}

void ChangedScene::cut(PointCloud& map) const {
  if (missing.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Vec3 p = toVec(map.points[i]);
    if (std::any_of(missing.begin(), missing.end(),
                    [&](const Region& region) { return region.contains(p); })) {
      continue;
    }
    map.points[kept] = map.points[i];
    map.intensity[kept++] = map.intensity[i];
  }
  map.points.resize(kept);
  map.intensity.resize(kept);
}

ChangedScene changeScene(const Scene& scene, const std::vector<Change>& changes,
                         const Motion& motion, const Raycaster& raycaster) {
  Changer changer(scene, motion, raycaster);
  for (const Change& change : changes) changer.apply(change);
  return changer.take();
}

}  // namespace paloc::synth
