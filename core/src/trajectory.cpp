#include "paloc/core/trajectory.h"

namespace paloc {

std::string toString(PoseFlag flag) {
  switch (flag) {
    case PoseFlag::kGood:
      return "good";
    case PoseFlag::kDegenerate:
      return "degenerate";
    case PoseFlag::kCoasting:
      return "coasting";
    case PoseFlag::kLost:
      return "lost";
  }
  return "unknown";
}

}  // namespace paloc
