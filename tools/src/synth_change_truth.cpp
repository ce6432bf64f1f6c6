#include <nlohmann/json.hpp>

#include "paloc/tools/synth_changed_scene.h"

namespace paloc::synth {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kTrackStride = 2;  // of the tracks' steps: ten positions a second

Json vecJson(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json poseJson(const Pose& pose) {
  const Quat q(pose.rotation);
  return {{"position_m", vecJson(pose.position)},
          {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

Json boxesJson(const std::vector<OrientedBox>& boxes) {
  Json list = Json::array();
  for (const OrientedBox& box : boxes) {
    list.push_back({{"T_map_box", poseJson(box.T_scene_box)},
                    {"low_m", vecJson(box.low)},
                    {"high_m", vecJson(box.high)}});
  }
  return list;
}

Json peopleJson(const WalkingPeople& people) {
  const PersonShape& shape = people.shape();
  Json json;
  json["radius_m"] = shape.radius_m;
  json["height_m"] = shape.head_m + shape.head_radius_m;
  json["start_ns"] = people.startNs();
  json["step_s"] = WalkingPeople::kStep_s * kTrackStride;
  json["tracks_m"] = Json::array();
  for (const WalkingPeople::Track& track : people.tracks()) {
    Json points = Json::array();
    for (std::size_t i = 0; i < track.size(); i += kTrackStride)
      points.push_back(vecJson(track[i]));
    json["tracks_m"].push_back(std::move(points));
  }
  return json;
}

}  // namespace

Json describeChanges(const ChangedScene& scene) {
  Json json;
  json["frame"] = "map (m)";
  json["objects"] = Json::array();
  for (const ChangedObject& object : scene.objects) {
    json["objects"].push_back({{"change", object.change},
                               {"name", object.name},
                               {"gone", boxesJson(object.gone)},
                               {"added", boxesJson(object.added)}});
  }
  if (!scene.people.empty()) json["people"] = peopleJson(scene.people);
  json["panes"] = Json::array();
  for (const GlassPane& pane : scene.panes) {
    json["panes"].push_back({{"T_map_pane", poseJson(pane.T_scene_pane)},
                             {"width_m", pane.width_m},
                             {"height_m", pane.height_m}});
  }
  json["missing_from_map"] = Json::array();
  for (const Region& region : scene.missing) {
    json["missing_from_map"].push_back(
        {{"low_m", vecJson(region.low)}, {"high_m", vecJson(region.high)}});
  }
  return json;
}

}  // namespace paloc::synth
