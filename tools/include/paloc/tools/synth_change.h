#pragma once

#include <string>
#include <vector>

namespace paloc::synth {

/// How the recorded place differs from the surveyed one.
enum class ChangeKind {
  kMovedWall,         ///< values: how far (m, default 0.3), which wall (default 0)
  kRemovedFurniture,  ///< values: how many pieces (default: all that the scene names)
  kAddedBox,          ///< values: how many (default 3)
  kWalkingPeople,     ///< values: how many (default 4)
  kGlass,             ///< panes that let through, mirror, and now and then return a ray
  kMissingPart,       ///< values: from and to along x, along y (m); default: what the scene names
};

struct Change {
  ChangeKind kind = ChangeKind::kMovedWall;
  std::vector<double> values;

  double value(std::size_t i, double otherwise) const {
    return i < values.size() ? values[i] : otherwise;
  }
};

std::string toString(ChangeKind kind);
/// In the order of the help.
std::vector<std::string> changeNames();
/// Reads "moved-wall" or "moved-wall=0.3,1". Throws UsageError for an unknown name, too many values
/// or one that is no number or out of its range.
Change parseChange(const std::string& text);

}  // namespace paloc::synth
