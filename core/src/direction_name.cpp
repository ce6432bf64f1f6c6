#include "paloc/core/direction_name.h"

#include <cmath>

namespace paloc {
namespace {

constexpr double kAlongCosine = 0.9397;  // 20 degrees
constexpr double kNamedShare = 0.24;     // where none is that near, the second has more than this

constexpr const char* kTranslations[] = {"along body x (heading)", "along body y (sideways)",
                                         "along body z (height)"};
constexpr const char* kRotations[] = {"roll", "pitch", "yaw"};

}  // namespace

std::string directionName(const Vec3& axis_body, bool rotation) {
  Eigen::Index largest = 0;
  const double size = axis_body.cwiseAbs().maxCoeff(&largest);
  if (!(size > 0)) return {};
  if (size >= kAlongCosine) return rotation ? kRotations[largest] : kTranslations[largest];
  // An axis and its opposite are one direction: the first that is named counts as positive.
  std::string axes;
  double sign = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (std::abs(axis_body[i]) < kNamedShare) continue;
    if (sign == 0) sign = axis_body[i];
    axes += axis_body[i] * sign > 0 ? '+' : '-';
    axes += "xyz"[i];
  }
  return (rotation ? "diagonal about body " : "diagonal along body ") + axes;
}

}  // namespace paloc
