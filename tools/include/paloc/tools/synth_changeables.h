#pragma once

#include <string>
#include <vector>

#include "paloc/core/pose.h"

namespace paloc::synth {

/// A box along the axes of the scene's frame (m).
struct Region {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();

  bool contains(const Vec3& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
};

/// Surfaces of a scene that may be taken away: all triangles that lie in the region.
struct Removable {
  std::string name;
  Region region;
};

/// Surfaces of a scene that may be moved, and where to.
struct MovableWall {
  std::string name;
  Region region;
  Vec3 direction = Vec3::UnitX();  ///< unit, scene frame
};

/// A pane of glass: a rectangle from the origin of its frame along x and z.
struct GlassPane {
  Pose T_scene_pane;
  double width_m = 0, height_m = 0;
};

/// What may differ between the surveyed scene and the recorded one. A scene may leave all empty.
struct Changeables {
  std::vector<MovableWall> walls;
  std::vector<Removable> furniture;
  std::vector<GlassPane> panes;
  std::vector<Region> missing;  ///< part that a survey may have left out: none or one
};

/// Of the scene "building".
Changeables buildingChangeables();

}  // namespace paloc::synth
