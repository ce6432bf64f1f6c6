#pragma once

#include <vector>

#include "paloc/tools/synth_changed_scene.h"

namespace paloc::synth {

/// Places on the floor beside a way, spread over it, where a box of 0.5 x 0.4 x 0.9 m stands free
/// of the scene and out of the way; fewer than wanted where there is no room.
std::vector<OrientedBox> placesForBoxes(std::size_t wanted, const Motion& motion,
                                        const Raycaster& scene);

/// Adds a box with surfaces of its own to a mesh.
void addBox(SceneMesh& mesh, const OrientedBox& box);

}  // namespace paloc::synth
