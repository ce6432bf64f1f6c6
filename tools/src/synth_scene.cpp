#include "paloc/tools/synth_scene.h"

#include <utility>

#include "paloc/core/errors.h"

namespace paloc::synth {
namespace {

using SceneMaker = Scene (*)();

// A further scene is a maker and a line here.
constexpr std::pair<const char*, SceneMaker> kScenes[] = {
    {"building", makeBuilding},
    {"room", makeRoom},
    {"corridor-0", [] { return makeCorridor(0); }},
    {"corridor-30", [] { return makeCorridor(30); }},
    {"corridor-45", [] { return makeCorridor(45); }},
    {"tunnel", makeTunnel},
    {"open-field", makeOpenField},
    {"stairwell", makeStairwell},
    {"parking-deck", makeParkingDeck},
    {"circular-hall", makeCircularHall},
};

}  // namespace

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : kScenes) names.emplace_back(name);
  return names;
}

Scene makeScene(const std::string& name) {
  std::string known;
  for (const auto& [scene_name, maker] : kScenes) {
    if (name == scene_name) {
      Scene scene = maker();
      scene.name = name;
      return scene;
    }
    known += (known.empty() ? "" : ", ") + std::string(scene_name);
  }
  throw UsageError("--scene: there is no scene \"" + name + "\"; there is: " + known);
}

}  // namespace paloc::synth
