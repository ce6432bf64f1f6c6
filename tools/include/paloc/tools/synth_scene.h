#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "paloc/tools/synth_changeables.h"
#include "paloc/tools/synth_mesh.h"

namespace paloc::synth {

/// A place to record in: surfaces, a way to walk, and where a surveyor would put the scanner.
struct Scene {
  std::string name;
  std::string description;  ///< one sentence
  SceneMesh mesh;
  /// Corners of a closed way over the floor (scene frame, m; the last leads back to the first). z
  /// is the floor's height there.
  std::vector<Vec3> route;
  std::vector<Vec3> survey_stations;  ///< the scanner's position (scene frame, m)
  Changeables changeables;            ///< what a recording may find changed
};

/// Names of all scenes, in the order of the help.
std::vector<std::string> sceneNames();

/// Builds a scene. Throws UsageError, naming those that exist, for an unknown name.
Scene makeScene(const std::string& name);

/// A floor of an office building, 25 x 15 x 3 m: seven furnished rooms on a corridor.
Scene makeBuilding();

/// Another storey of that building: the same walls, doors, windows, lamps and route, the furniture
/// picked at random for each `storey`. Not among sceneNames().
Scene makeBuildingStorey(std::uint64_t storey);

/// A furnished room, 8 x 6 x 3 m.
Scene makeRoom();

/// A bare corridor, 2.4 m wide and 2.6 m high, between two furnished rooms whose far sides stand
/// open, so that from its inside nothing ends the view: its axis is free from `kCorridorMouthM` on
/// to as far before its end. It leads from the scene's origin along +x, turned by `yaw_deg` about
/// z. The route goes through it to the far room and back.
Scene makeCorridor(double yaw_deg, double length_m = 76);
constexpr double kCorridorMouthM = 8;

/// A smooth, bare tunnel, 100 m long, open at both ends: a round bore of 3.2 m radius over a road.
Scene makeTunnel();

/// Flat ground with one wall, 60 m long and 4 m high.
Scene makeOpenField();

/// A stairwell of three storeys, 2.8 x 5.9 x 12 m.
Scene makeStairwell();

/// A parking deck, 48 x 30 x 2.8 m: pillars and parapets between a flat floor and a flat ceiling.
Scene makeParkingDeck();

/// A bare round hall of 12 m radius, 5 m high: its yaw is free.
Scene makeCircularHall();

}  // namespace paloc::synth
