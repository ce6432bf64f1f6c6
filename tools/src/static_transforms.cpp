#include "paloc/tools/static_transforms.h"

#include <map>

namespace paloc {

std::optional<Pose> StaticTransforms::find(const std::string& from, const std::string& to) const {
  std::map<std::string, Pose> reached{{from, Pose{}}};
  for (bool further = true; further && !reached.contains(to);) {
    further = false;
    for (const RosTransform& t : transforms_) {
      const auto frame = reached.find(t.frame), child = reached.find(t.child_frame);
      if ((frame == reached.end()) == (child == reached.end())) continue;
      if (child == reached.end()) {
        reached.emplace(t.child_frame, frame->second * t.T_frame_child);
      } else {
        reached.emplace(t.frame, child->second * t.T_frame_child.inverse());
      }
      further = true;
    }
  }
  const auto found = reached.find(to);
  if (found == reached.end() || !found->second.rotation.allFinite()) return std::nullopt;
  return found->second;
}

}  // namespace paloc
