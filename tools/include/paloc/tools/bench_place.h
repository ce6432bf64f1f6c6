#pragma once

#include <memory>

#include "paloc/core/scan.h"
#include "paloc/map/prior_map.h"
#include "paloc/tools/synth_raycaster.h"
#include "paloc/tools/synth_scene.h"
#include "paloc/tools/synth_sensor.h"
#include "paloc/tools/synth_survey.h"

namespace paloc {

/// A scene with the map that a survey of it gives, in which scans are taken in memory.
class BenchPlace {
 public:
  BenchPlace(synth::Scene scene, const synth::SurveyModel& survey, const MapSettings& settings,
             std::uint64_t seed);

  const synth::Scene& scene() const { return scene_; }
  const synth::Raycaster& raycaster() const { return raycaster_; }
  const std::shared_ptr<const PriorMap>& map() const { return map_; }
  /// A map of the part of the survey on one side of a plane, that of smaller normal . x (m).
  std::shared_ptr<const PriorMap> mapBefore(const Vec3& normal, double height_m) const;

  /// The `index`-th random pose: along the scene's route, 0.3 m aside, 0.2 m up and down, any
  /// heading, tilted by up to some 10 degrees.
  Pose pose(std::size_t index) const;
  /// A scan of the body standing still there, in its frame. `index` picks the noise.
  Scan scanAt(const synth::SensorModel& sensor, const Pose& T_map_body, std::size_t index) const;

 private:
  synth::Scene scene_;
  synth::Raycaster raycaster_;
  std::uint64_t seed_;
  MapSettings settings_;
  PointCloud survey_;
  std::shared_ptr<const PriorMap> map_;
};

/// The mirror image of a scene, y for -y.
synth::Scene mirrored(synth::Scene scene);

}  // namespace paloc
