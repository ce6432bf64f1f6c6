#pragma once

#include <cstdint>

#include "paloc/map/point_cloud.h"
#include "paloc/tools/synth_raycaster.h"

namespace paloc::synth {

/// A terrestrial laser scanner and what is done with its scans. Defaults: like a Leica BLK360.
struct SurveyModel {
  double angular_step_deg = 0.2;
  double lowest_elevation_deg = -60;  ///< below, the tripod
  double min_range_m = 0.6;
  double max_range_m = 60;
  double range_noise_m = 0.003;  ///< standard deviation, white
  double surface_bias_m =
      0.002;                 ///< standard deviation; a shift of a whole surface along its normal
  double spacing_m = 0.025;  ///< the merged cloud keeps one point per voxel of this edge
};

/// What the survey of a scene from some stations gives: the merged, thinned cloud in the scene's
/// frame. Deterministic in the seed, on any number of threads.
PointCloud survey(const SurveyModel& model, const SceneMesh& mesh, const Raycaster& raycaster,
                  const std::vector<Vec3>& stations, std::uint64_t seed);

}  // namespace paloc::synth
