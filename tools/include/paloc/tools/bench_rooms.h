#pragma once

#include <cstdint>
#include <vector>

#include "paloc/map/point_cloud.h"
#include "paloc/tools/synth_mesh.h"

/// The scene that the registration is measured in: a storey of many furnished rooms.
namespace paloc::synth {

/// A building and places in it where a scanner may be.
struct Rooms {
  SceneMesh mesh;
  std::vector<Pose>
      places;  ///< T_map_body: 1.0 to 1.7 m high, any heading, tilted by a few degrees
  std::size_t rooms = 0;
};

/// A storey of rooms of 4 to 7 m by 4 to 6 m, 3 m high, with walls of 12 cm (two faces), doors and
/// furniture, as many of them as it takes for about `surface_m2` of surface. Deterministic in the
/// seed.
Rooms makeRooms(double surface_m2, std::size_t places, std::uint64_t seed);

/// Points on all surfaces of a mesh, one in each cell of a grid of this spacing, anywhere in it,
/// with white noise across the surface (1 sigma).
PointCloud sampleSurfaces(const SceneMesh& mesh, double spacing_m, double noise_m,
                          std::uint64_t seed);

}  // namespace paloc::synth
