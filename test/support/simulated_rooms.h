#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/core/scan.h"
#include "paloc/map/point_cloud.h"

namespace paloc::test {

/// An axis-aligned box in the world's own frame. Seen from inside (a room) or from outside
/// (furniture).
struct Box {
  Vec3 low, high;
};

/// A world of boxes: one or more rooms and what stands in them. The map is the world turned and
/// moved by T_map_world, so that nothing need lie along the map's axes.
struct BoxWorld {
  std::vector<Box> boxes;
  Pose T_map_world;
  std::vector<int>
      open_faces;  ///< faces of the first box that are missing: 2 * axis + (high ? 1 : 0)

  bool isOpen(std::size_t box, int face) const {
    if (box != 0) return false;
    for (int open : open_faces) {
      if (open == face) return true;
    }
    return false;
  }
};

inline BoxWorld emptyRoom() { return {{{Vec3(-5, -4, 0), Vec3(5, 4, 3)}}, {}, {}}; }

inline BoxWorld furnishedRoom() {
  BoxWorld world = emptyRoom();
  world.boxes.push_back({Vec3(-5, -4, 0), Vec3(-4.2, -1.5, 1.9)});
  world.boxes.push_back({Vec3(1.2, 1.1, 0), Vec3(2.8, 2.3, 0.8)});
  world.boxes.push_back({Vec3(3.6, -4, 0), Vec3(5, -3.1, 1.2)});
  world.boxes.push_back({Vec3(-1.5, 2.9, 0), Vec3(-0.7, 4, 2.2)});
  world.T_map_world = {Vec3(3, -2, 1), so3::exp(Vec3(0.02, -0.01, 0.4))};
  return world;
}

/// A bare corridor, 2.4 m wide and 60 m long, without its ends, turned by `yaw` in the map.
inline BoxWorld corridor(double yaw) {
  return {{{Vec3(-30, -1.2, 0), Vec3(30, 1.2, 2.6)}},
          {Vec3::Zero(), so3::exp(Vec3(0, 0, yaw))},
          {0, 1}};
}

/// Samples every face on a grid, with noise across it (m, 1 sigma) and a shift in the grid by
/// chance.
inline PointCloud sampleMap(const BoxWorld& world, double spacing_m, double noise_m,
                            unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  PointCloud cloud;
  for (std::size_t b = 0; b < world.boxes.size(); ++b) {
    for (int face = 0; face < 6; ++face) {
      if (world.isOpen(b, face)) continue;
      const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
      const Box& box = world.boxes[b];
      const auto cells = [&](int along) {
        return static_cast<int>(std::ceil((box.high[along] - box.low[along]) / spacing_m));
      };
      for (int i = 0; i < cells(u); ++i) {
        for (int k = 0; k < cells(v); ++k) {
          const double a = box.low[u] + i * spacing_m, c = box.low[v] + k * spacing_m;
          Vec3 p;
          p[axis] = (face % 2 == 1 ? box.high[axis] : box.low[axis]) + noise_m * normal(random);
          p[u] = std::min(a + spacing_m * uniform(random), box.high[u]);
          p[v] = std::min(c + spacing_m * uniform(random), box.high[v]);
          const Vec3 m = world.T_map_world * p;
          cloud.points.push_back(
              {static_cast<float>(m.x()), static_cast<float>(m.y()), static_cast<float>(m.z())});
        }
      }
    }
  }
  return cloud;
}

/// What a ray hits: range, box and face; range infinite when nothing.
struct Hit {
  double range = std::numeric_limits<double>::infinity();
  std::size_t box = 0;
  int face = -1;
};

inline Hit castRay(const BoxWorld& world, const Vec3& from_world, const Vec3& direction_world) {
  Hit best;
  for (std::size_t b = 0; b < world.boxes.size(); ++b) {
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
      const Box& box = world.boxes[b];
      if (world.isOpen(b, face) || direction_world[axis] == 0) continue;
      const double plane = face % 2 == 1 ? box.high[axis] : box.low[axis];
      const double range = (plane - from_world[axis]) / direction_world[axis];
      const Vec3 p = from_world + range * direction_world;
      if (range > 0.3 && range < best.range && p[u] >= box.low[u] && p[u] <= box.high[u] &&
          p[v] >= box.low[v] && p[v] <= box.high[v]) {
        best = {range, b, face};
      }
    }
  }
  return best;
}

/// Errors of a simulated scan, 1 sigma each (m).
struct ScanNoise {
  double range_m = 0.02;
  double plane_bias_m = 0;  ///< of each face, drawn anew for the scan
  double range_bias_m = 0;  ///< of the whole scan
};

/// A scan of `count` rays spread evenly at random over the directions up to 45 degrees from the
/// horizontal.
inline Scan simulateScan(const BoxWorld& world, const Pose& T_map_body, int count,
                         const ScanNoise& noise, double max_range_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> biases(6 * world.boxes.size());
  for (double& bias : biases) bias = noise.plane_bias_m * normal(random);
  const double range_bias = noise.range_bias_m * normal(random);
  const Pose T_world_body = world.T_map_world.inverse() * T_map_body;
  Scan scan;
  while (count-- > 0) {
    const double azimuth = 3.14159265358979 * uniform(random), z = 0.7071 * uniform(random);
    const double level = std::sqrt(1 - z * z);
    const Vec3 ray(level * std::cos(azimuth), level * std::sin(azimuth), z);
    const Vec3 ray_world = T_world_body.rotation * ray;
    const Hit hit = castRay(world, T_world_body.position, ray_world);
    if (hit.face < 0 || hit.range > max_range_m) continue;
    // A face that stands `bias` further out is met later, the flatter the ray the more.
    const double bias = biases[6 * hit.box + static_cast<std::size_t>(hit.face)];
    const double cosine = std::max(std::abs(ray_world[hit.face / 2]), 0.05);
    const Vec3 p = ray * (hit.range + bias / cosine + range_bias + noise.range_m * normal(random));
    scan.points_body.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return scan;
}

}  // namespace paloc::test
