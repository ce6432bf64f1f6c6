#pragma once

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

}  // namespace paloc::synth
