#pragma once

#include <optional>
#include <string>
#include <vector>

#include "paloc/tools/ros_messages.h"

namespace paloc {

/// The transforms between frames that do not move.
class StaticTransforms {
 public:
  void add(RosTransform transform) { transforms_.push_back(std::move(transform)); }
  bool empty() const { return transforms_.empty(); }
  /// T_from_to, along the transforms given; nothing if none lead there.
  std::optional<Pose> find(const std::string& from, const std::string& to) const;

 private:
  std::vector<RosTransform> transforms_;
};

}  // namespace paloc
