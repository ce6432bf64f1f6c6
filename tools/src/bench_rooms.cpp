#include "paloc/tools/bench_rooms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "paloc/tools/synth_furnish.h"
#include "paloc/tools/synth_furniture.h"
#include "paloc/tools/synth_random.h"

namespace paloc::synth {
namespace {

constexpr double kHeight = 3, kThickness = 0.12;
constexpr double kSurfaceOfRoom = 212;  // of an average room and what stands in it (m2)
constexpr float kPlaster = 0.7F, kFloor = 0.4F;

/// Where the walls of a grid of rooms stand along one axis (m).
std::vector<double> gridLines(std::size_t rooms, double shortest, double longest,
                              RandomStream& random) {
  std::vector<double> lines{0};
  for (std::size_t i = 0; i < rooms; ++i) {
    lines.push_back(lines.back() + shortest + (longest - shortest) * random.uniform());
  }
  return lines;
}

/// A wall along the grid, with a door into every room.
void wallWithDoors(MeshBuilder& b, const Pose& T, const std::vector<double>& along, bool outer,
                   RandomStream& random) {
  std::vector<WallOpening> doors;
  for (std::size_t i = 0; !outer && i + 1 < along.size(); ++i) {
    const double from = along[i] + 0.7 + (along[i + 1] - along[i] - 2.5) * random.uniform();
    doors.push_back({from, from + 0.95, 0, 2.05});
  }
  b.wall(T, along.back(), kThickness, kHeight, doors, kPlaster);
  for (const WallOpening& door : doors) {
    addDoor(b, T, door, kThickness, random.uniform() < 0.5 ? 0 : random.sign() * 95);
  }
}

Pose somewhereIn(const Vec3& low, const Vec3& high, RandomStream& random) {
  constexpr double kClear = 1.3;  // of what stands along the walls
  Pose T_map_body;
  for (int axis = 0; axis < 2; ++axis) {
    const double span = high[axis] - low[axis] - 2 * kClear;
    T_map_body.position[axis] = low[axis] + kClear + span * random.uniform();
  }
  T_map_body.position.z() = 1 + 0.7 * random.uniform();
  T_map_body.rotation = so3::exp(Vec3(0, 0, 2 * std::numbers::pi * random.uniform())) *
                        so3::exp(Vec3(0.05 * random.normal(), 0.05 * random.normal(), 0));
  return T_map_body;
}

Vec3 toVec(const Point3f& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

void sampleTriangle(const SceneMesh& mesh, std::size_t triangle, double spacing_m, double noise_m,
                    RandomStream& random, std::vector<Point3f>& points) {
  const auto& corners = mesh.triangles[triangle];
  // The corner after the longest side first: in the halves of a rectangle, its right angle.
  std::size_t first = 0;
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side =
        (toVec(mesh.vertices[corners[(i + 2) % 3]]) - toVec(mesh.vertices[corners[(i + 1) % 3]]))
            .norm();
    if (side > longest) longest = side, first = i;
  }
  const Vec3 origin = toVec(mesh.vertices[corners[first]]);
  const Vec3 a = toVec(mesh.vertices[corners[(first + 1) % 3]]) - origin;
  const Vec3 b = toVec(mesh.vertices[corners[(first + 2) % 3]]) - origin;
  const Vec3 normal = a.cross(b).normalized();
  const double cells_a = a.norm() / spacing_m, cells_b = b.norm() / spacing_m;
  if (cells_a <= 0 || cells_b <= 0) return;
  for (double i = random.uniform() - 1; i < cells_a; ++i) {
    for (double k = random.uniform() - 1; k < cells_b; ++k) {
      const double u = (i + random.uniform()) / cells_a, v = (k + random.uniform()) / cells_b;
      if (u < 0 || v < 0 || u + v > 1) continue;
      const Vec3 p = origin + u * a + v * b + noise_m * random.normal() * normal;
      points.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
  }
}

}  // namespace

Rooms makeRooms(double surface_m2, std::size_t places, std::uint64_t seed) {
  RandomStream random(seed, RandomPurpose::kRooms, 0);
  const double wanted = std::max(surface_m2 / kSurfaceOfRoom, 1.0);
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(wanted)));
  const auto rows = static_cast<std::size_t>(std::ceil(wanted / static_cast<double>(columns)));
  const std::vector<double> xs = gridLines(columns, 4, 7, random);
  const std::vector<double> ys = gridLines(rows, 4, 6, random);
  MeshBuilder b;
  b.box(Pose{}, Vec3(-0.1, -0.1, -0.3), Vec3(xs.back() + 0.1, ys.back() + 0.1, 0), kFloor);
  b.box(Pose{}, Vec3(-0.1, -0.1, kHeight), Vec3(xs.back() + 0.1, ys.back() + 0.1, kHeight + 0.3),
        kPlaster);
  for (std::size_t i = 0; i < ys.size(); ++i) {
    wallWithDoors(b, onFloor(0, ys[i]), xs, i == 0 || i == rows, random);
  }
  for (std::size_t i = 0; i < xs.size(); ++i) {
    wallWithDoors(b, onFloor(xs[i], 0, 90), ys, i == 0 || i == columns, random);
  }
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t k = 0; k < rows; ++k) {
      const Vec3 low(xs[i], ys[k], 0), high(xs[i + 1], ys[k + 1], kHeight);
      addLamp(b, onFloor((low.x() + high.x()) / 2, (low.y() + high.y()) / 2), 1.2, 0.3, kHeight);
      furnishRoom(b, low, high, random);
    }
  }
  Rooms rooms;
  rooms.rooms = columns * rows;
  for (std::size_t n = 0; n < places; ++n) {
    const auto i = static_cast<std::size_t>(random.uniform() * static_cast<double>(columns));
    const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(rows));
    rooms.places.push_back(
        somewhereIn(Vec3(xs[i], ys[k], 0), Vec3(xs[i + 1], ys[k + 1], 0), random));
  }
  rooms.mesh = b.take();
  return rooms;
}

PointCloud sampleSurfaces(const SceneMesh& mesh, double spacing_m, double noise_m,
                          std::uint64_t seed) {
  RandomStream random(seed, RandomPurpose::kSurvey, 0);
  PointCloud cloud;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    sampleTriangle(mesh, i, spacing_m, noise_m, random, cloud.points);
  }
  return cloud;
}

}  // namespace paloc::synth
