#include "paloc/tools/synth_mesh.h"

#include <cmath>
#include <numbers>

namespace paloc::synth {

std::uint32_t MeshBuilder::newSurface(float reflectivity) {
  mesh_.surface_reflectivity.push_back(reflectivity);
  return static_cast<std::uint32_t>(mesh_.surfaces() - 1);
}

std::uint32_t MeshBuilder::newBoxSurfaces(float reflectivity) {
  const std::uint32_t first = newSurface(reflectivity);
  for (int i = 1; i < 6; ++i) newSurface(reflectivity);
  return first;
}

std::uint32_t MeshBuilder::vertex(const Vec3& p) {
  mesh_.vertices.push_back(
      {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

// Counter-clockwise as seen from outside.
void MeshBuilder::quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                       std::uint32_t surface) {
  const std::uint32_t ia = vertex(a), ib = vertex(b), ic = vertex(c), id = vertex(d);
  mesh_.triangles.push_back({ia, ib, ic});
  mesh_.triangles.push_back({ia, ic, id});
  mesh_.triangle_surface.insert(mesh_.triangle_surface.end(), 2, surface);
}

void MeshBuilder::box(const Pose& T_scene_piece, const Vec3& low, const Vec3& high,
                      float reflectivity) {
  box(T_scene_piece, low, high, newBoxSurfaces(reflectivity));
}

void MeshBuilder::box(const Pose& T_scene_piece, const Vec3& low, const Vec3& high,
                      std::uint32_t surfaces) {
  const auto corner = [&](int x, int y, int z) {
    return T_scene_piece *
           Vec3(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  quad(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0), surfaces);
  quad(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1), surfaces + 1);
  quad(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1), surfaces + 2);
  quad(corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0), surfaces + 3);
  quad(corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0), surfaces + 4);
  quad(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1), surfaces + 5);
}

void MeshBuilder::cylinder(const Pose& T_scene_piece, double radius_bottom, double radius_top,
                           double z_low, double z_high, float reflectivity) {
  constexpr int kSides = 24;
  const std::uint32_t side = newSurface(reflectivity);
  const std::uint32_t bottom = newSurface(reflectivity), top = newSurface(reflectivity);
  const auto rim = [&](int i, double radius, double z) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    return T_scene_piece * Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  const auto cap = [&](const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t surface) {
    mesh_.triangles.push_back({vertex(a), vertex(b), vertex(c)});
    mesh_.triangle_surface.push_back(surface);
  };
  for (int i = 0; i < kSides; ++i) {
    const Vec3 b0 = rim(i, radius_bottom, z_low), b1 = rim(i + 1, radius_bottom, z_low);
    const Vec3 t0 = rim(i, radius_top, z_high), t1 = rim(i + 1, radius_top, z_high);
    quad(b0, b1, t1, t0, side);
    cap(b1, b0, T_scene_piece * Vec3(0, 0, z_low), bottom);
    cap(t0, t1, T_scene_piece * Vec3(0, 0, z_high), top);
  }
}

void MeshBuilder::wall(const Pose& T_scene_piece, double length, double thickness, double height,
                       const std::vector<WallOpening>& openings, float reflectivity) {
  const std::uint32_t surfaces = newBoxSurfaces(reflectivity);
  const auto piece = [&](double from, double to, double bottom, double top) {
    if (to <= from || top <= bottom) return;
    box(T_scene_piece, Vec3(from, -thickness / 2, bottom), Vec3(to, thickness / 2, top), surfaces);
  };
  double at = 0;
  for (const WallOpening& opening : openings) {
    piece(at, opening.from_m, 0, height);
    piece(opening.from_m, opening.to_m, 0, opening.bottom_m);
    piece(opening.from_m, opening.to_m, opening.top_m, height);
    at = opening.to_m;
  }
  piece(at, length, 0, height);
}

void MeshBuilder::sweep(const Pose& T_scene_piece, const std::vector<Vec3>& line, const Vec3& along,
                        float reflectivity) {
  const std::uint32_t surface = newSurface(reflectivity);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec3 &a = line[i - 1], &b = line[i];
    quad(T_scene_piece * a, T_scene_piece * b, T_scene_piece * (b + along),
         T_scene_piece * (a + along), surface);
  }
}

Pose onFloor(double x, double y, double yaw_deg, double z) {
  return {Vec3(x, y, z), so3::exp(Vec3(0, 0, yaw_deg * std::numbers::pi / 180))};
}

}  // namespace paloc::synth
