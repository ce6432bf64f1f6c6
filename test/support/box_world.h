#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "paloc/core/imu_sample.h"
#include "paloc/core/pose.h"
#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/frontends/mrpt_time.h"

/// A sensor that moves along a known path in an empty room, for tests of point times and deskewing.
namespace paloc::test {

/// A motion through the room by closed formulas: T_world_body at a time (s).
using Path = std::function<Pose(double)>;

/// Even speed (m/s, world) and even turning (rad/s, body).
inline Path constantTwist(const Vec3& v_world, const Vec3& omega_body) {
  return [=](double t) { return Pose{v_world * t, so3::exp(omega_body * t)}; };
}

/// Swaying as in a quick walk: up to about 1.7 m/s and 2 rad/s, with accelerations of some m/s2.
inline Path sway() {
  return [](double t) {
    const Vec3 position(1.2 * std::sin(1.1 * t), 0.3 * std::sin(2.3 * t + 1),
                        0.04 * std::sin(12 * t));
    const Vec3 turn(0.10 * std::sin(7 * t), 0.08 * std::cos(5 * t), 1.1 * std::sin(1.5 * t));
    return Pose{position, so3::exp(turn)};
  };
}

/// What a perfect IMU would measure on a path: central differences of the path.
inline ImuSample imuOnPath(const Path& path, TimeNs t_ns, double gravity = 9.81) {
  const double t = static_cast<double>(t_ns) * 1e-9, h = 1e-4;
  const Pose before = path(t - h), now = path(t), after = path(t + h);
  const Vec3 a_world = (after.position - 2 * now.position + before.position) / (h * h);
  ImuSample sample;
  sample.t_ns = t_ns;
  sample.acc_body = now.rotation.transpose() * (a_world + gravity * Vec3::UnitZ());
  sample.omega_body = so3::log(before.rotation.transpose() * after.rotation) / (2 * h);
  return sample;
}

/// A room around the origin of the world: |x| < 5, |y| < 4, |z| < 1.5 m.
struct BoxRoom {
  Vec3 half = Vec3(5, 4, 1.5);

  /// Range of the wall from a point inside along a unit vector.
  double range(const Vec3& from, const Vec3& direction) const {
    double nearest = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) continue;
      const double wall = direction[axis] > 0 ? half[axis] : -half[axis];
      nearest = std::min(nearest, (wall - from[axis]) / direction[axis]);
    }
    return nearest;
  }

  /// Distance of a point from the nearest wall.
  double offWall(const Vec3& point) const {
    double off = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      off = std::min(off, std::abs(std::abs(point[axis]) - half[axis]));
    }
    return off;
  }
};

/// A scan of the room by a sensor that turns once in `duration_ns`, each column at its own time.
inline obs::CObservationLidarScan scanRoom(const BoxRoom& room, const Path& path,
                                           const Pose& T_body_lidar, TimeNs start_ns,
                                           TimeNs duration_ns, int columns = 360, int rings = 16) {
  obs::CObservationLidarScan scan;
  scan.timestamp = toMrptTime(start_ns);
  scan.sensorLabel = "lidar";
  scan.duration_ns = static_cast<std::uint32_t>(duration_ns);
  for (int column = 0; column < columns; ++column) {
    const TimeNs dt = duration_ns * column / (columns - 1);
    const Pose T_world_lidar = path(static_cast<double>(start_ns + dt) * 1e-9) * T_body_lidar;
    for (int ring = 0; ring < rings; ++ring) {
      const double azimuth = 2 * std::numbers::pi * column / columns;
      const double elevation = (ring - 0.5 * (rings - 1)) * 2.0 * std::numbers::pi / 180;
      const Vec3 ray(std::cos(elevation) * std::cos(azimuth),
                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Vec3 hit = room.range(T_world_lidar.position, T_world_lidar.rotation * ray) * ray;
      scan.x.push_back(static_cast<float>(hit.x()));
      scan.y.push_back(static_cast<float>(hit.y()));
      scan.z.push_back(static_cast<float>(hit.z()));
      scan.dt_ns.push_back(static_cast<std::uint32_t>(dt));
      scan.intensity.push_back(static_cast<std::uint16_t>(column));
      scan.ring.push_back(static_cast<std::uint16_t>(ring));
    }
  }
  return scan;
}

/// The largest distance from the walls of points given in the body frame at a pose.
inline double worstOffWall(const BoxRoom& room, const Pose& T_world_body,
                           const std::vector<Point3f>& points_body) {
  double worst = 0;
  for (const Point3f& p : points_body) {
    worst = std::max(worst, room.offWall(T_world_body * Vec3(p.x, p.y, p.z)));
  }
  return worst;
}

}  // namespace paloc::test
