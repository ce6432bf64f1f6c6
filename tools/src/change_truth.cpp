#include "paloc/tools/change_truth.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"

namespace paloc {
namespace {

using Json = nlohmann::json;

Vec3 vecOf(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

ChangeTruth::Box boxOf(const Json& json, const std::string& name) {
  const Json& pose = json.at("T_map_box");
  const Json& q = pose.at("quaternion_xyzw");
  const Quat rotation(q.at(3).get<double>(), q.at(0).get<double>(), q.at(1).get<double>(),
                      q.at(2).get<double>());
  return {name,
          {vecOf(pose.at("position_m")), rotation.normalized().toRotationMatrix()},
          vecOf(json.at("low_m")),
          vecOf(json.at("high_m"))};
}

bool between(const Vec3& p, const Vec3& low, const Vec3& high) {
  return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
}

// Horizontal distance of a point to the way from one place to the next.
double distanceToStep(const Vec3& p, const Vec3& from, const Vec3& to) {
  const Eigen::Vector2d step = (to - from).head<2>(), there = (p - from).head<2>();
  const double length_sq = step.squaredNorm();
  const double share = length_sq > 0 ? std::clamp(there.dot(step) / length_sq, 0.0, 1.0) : 0;
  return (there - share * step).norm();
}

}  // namespace

bool ChangeTruth::Box::contains(const Vec3& p_map, double margin_m, double below_m) const {
  const Vec3 margin = Vec3::Constant(margin_m);
  Vec3 bottom = low - margin;
  bottom.z() = low.z() - below_m;
  return between(T_map_box.inverse() * p_map, bottom, high + margin);
}

bool ChangeTruth::Region::contains(const Vec3& p_map, double margin_m) const {
  return between(p_map, low - Vec3::Constant(margin_m), high + Vec3::Constant(margin_m));
}

bool ChangeTruth::sweptByPeople(const Vec3& p, double margin_m, double below_m) const {
  for (const std::vector<Vec3>& track : tracks_) {
    for (std::size_t i = 0; i + 1 < track.size(); ++i) {
      const double above_m = p.z() - track[i].z();
      if (above_m < -below_m || above_m > height_m_ + margin_m) continue;
      if (distanceToStep(p, track[i], track[i + 1]) <= radius_m_ + margin_m) return true;
    }
  }
  return false;
}

ChangeTruth ChangeTruth::load(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw IoError(file.string() + ": cannot be read");
  ChangeTruth truth;
  try {
    const Json json = Json::parse(in);
    for (const Json& object : json.at("objects")) {
      const std::string name = object.at("name");
      for (const Json& box : object.at("gone")) truth.gone.push_back(boxOf(box, name));
      for (const Json& box : object.at("added")) truth.added.push_back(boxOf(box, name));
    }
    for (const Json& region : json.at("missing_from_map")) {
      truth.missing.push_back({vecOf(region.at("low_m")), vecOf(region.at("high_m"))});
    }
    if (json.contains("people")) {
      const Json& people = json.at("people");
      truth.radius_m_ = people.at("radius_m");
      truth.height_m_ = people.at("height_m");
      for (const Json& track : people.at("tracks_m")) {
        truth.tracks_.emplace_back();
        for (const Json& place : track) truth.tracks_.back().push_back(vecOf(place));
      }
    }
  } catch (const Json::exception& e) {
    throw IoError(file.string() + ": is not a changes.json of paloc synth: " + e.what());
  }
  return truth;
}

}  // namespace paloc
