#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "paloc/core/pose.h"

namespace paloc::synth {

/// Triangles of a scene, in the scene's frame, which is the map's frame (m, z up). Triangles belong
/// to surfaces: one side of a wall, one face of a cupboard.
struct SceneMesh {
  std::vector<Point3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_surface;  ///< one per triangle
  std::vector<float> surface_reflectivity;      ///< one per surface, diffuse, 0..1

  std::size_t surfaces() const { return surface_reflectivity.size(); }
};

/// A rectangular hole in a wall: from `from_m` to `to_m` along the wall, between two heights.
struct WallOpening {
  double from_m = 0, to_m = 0;
  double bottom_m = 0, top_m = 0;
};

/// Puts simple bodies together to a mesh. Poses T_scene_piece place a body that is given in the
/// piece's own frame; all sizes in m.
class MeshBuilder {
 public:
  /// Six new surfaces, for the faces -x, +x, -y, +y, -z, +z of a box. Returns the first.
  std::uint32_t newBoxSurfaces(float reflectivity);

  /// A box between two corners, with six surfaces of its own, or with those that begin at
  /// `surfaces`.
  void box(const Pose& T_scene_piece, const Vec3& low, const Vec3& high, float reflectivity);
  void box(const Pose& T_scene_piece, const Vec3& low, const Vec3& high, std::uint32_t surfaces);

  /// An upright cylinder, or a cone's frustum, about the piece's z axis.
  void cylinder(const Pose& T_scene_piece, double radius_bottom, double radius_top, double z_low,
                double z_high, float reflectivity);

  /// A wall along the piece's x axis from 0 to `length`, `thickness` thick about y = 0, up to
  /// `height`. Openings must be in order and must not overlap. Each side of it is one surface.
  void wall(const Pose& T_scene_piece, double length, double thickness, double height,
            const std::vector<WallOpening>& openings, float reflectivity);

  /// The surface that an open line (at least two points, piece's frame) sweeps when it is moved by
  /// `along`: one surface without thickness, seen from both sides. A curve of many short pieces
  /// makes it smooth.
  void sweep(const Pose& T_scene_piece, const std::vector<Vec3>& line, const Vec3& along,
             float reflectivity);

  SceneMesh take() { return std::move(mesh_); }

 private:
  std::uint32_t newSurface(float reflectivity);
  std::uint32_t vertex(const Vec3& point_scene);
  void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, std::uint32_t surface);

  SceneMesh mesh_;
};

/// A pose on the floor: position (m) and yaw (degrees).
Pose onFloor(double x, double y, double yaw_deg = 0, double z = 0);

}  // namespace paloc::synth
