#pragma once

#include <nlohmann/json_fwd.hpp>

#include "paloc/map/point_cloud.h"
#include "paloc/tools/synth_change.h"
#include "paloc/tools/synth_scene.h"
#include "paloc/tools/synth_surroundings.h"

namespace paloc::synth {

/// An upright box on a pose (m).
struct OrientedBox {
  Pose T_scene_box;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// One object that is in the map or in the recording only.
struct ChangedObject {
  std::string change, name;
  std::vector<OrientedBox> gone;   ///< map points in here (to some cm) are no longer there
  std::vector<OrientedBox> added;  ///< scan points in here are of something the map has not
};

/// A scene as it is recorded, after changes: the survey was made before them.
struct ChangedScene {
  SceneMesh mesh;
  WalkingPeople people;
  std::uint32_t people_surface = 0, glass_surface = 0;
  std::vector<GlassPane> panes;
  std::vector<Region> missing;  ///< of the survey
  std::vector<ChangedObject> objects;

  Surroundings surroundings(const Raycaster& raycaster) const;
  /// Leaves out what the survey misses.
  void cut(PointCloud& map) const;
};

/// Applies changes in their order. `raycaster` holds the scene's own mesh; boxes and people are put
/// beside the way of `motion`. Throws UsageError where the scene has nothing to be changed so.
ChangedScene changeScene(const Scene& scene, const std::vector<Change>& changes,
                         const Motion& motion, const Raycaster& raycaster);

/// The truth of the changes: objects with their boxes, people with their tracks, panes, the missing
/// part (scene frame, m; times in s since the motion's start).
nlohmann::ordered_json describeChanges(const ChangedScene& scene);

}  // namespace paloc::synth
