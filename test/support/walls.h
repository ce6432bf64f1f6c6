#pragma once

#include <random>
#include <vector>

#include "paloc/frontends/local_voxel_map.h"
#include "paloc/frontends/measured_point.h"

namespace paloc::test {

/// Points on planes across the given axes, at +-`distance_m`, with 1 cm of noise; the body is at
/// rest at the origin, in the middle of them. At 3 m they lie where voxels meet.
struct Walls {
  std::vector<MeasuredPoint> points;
  std::vector<Vec3> map_points;
  LocalVoxelMap map{{}};  // of these

  explicit Walls(const std::vector<int>& axes, double distance_m = 3) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0, 0.01);
    std::uniform_real_distribution<double> along(-3, 3);
    for (int i = 0; i < 60'000; ++i) {
      const int axis = axes[static_cast<std::size_t>(i) % axes.size()];
      Vec3 point(along(random), along(random), along(random));
      point[axis] = ((i / 6) % 2 == 0 ? distance_m : -distance_m) + noise(random);
      if (i < 58'000) {
        map_points.push_back(point);
        map.add(point, point);
      } else {
        points.push_back({point, 0});
      }
    }
    map.endScan(Vec3::Zero());
  }
};

}  // namespace paloc::test
