#include "paloc/core/surface_errors.h"

#include <algorithm>

#include "paloc/core/direction_information.h"
#include "paloc/core/shared_errors.h"

namespace paloc {

void SurfaceErrors::add(std::size_t node, const MapMatch& match, double scans,
                        double robust_weight) {
  if (!match.surfaces || robust_weight <= 0) return;
  // A shift does not move the match along what is not known.
  const Mat6 gain = match.surface_bias_m *
                    gainUnderSharedErrors(match.information, scans * match.shared_spread) *
                    projectorOntoKnown(match.information);
  for (const SurfaceGradient& surface : *match.surfaces) {
    const auto number = static_cast<std::size_t>(surface.surface);
    constant_.resize(std::max(constant_.size(), number + 1));
    const Vec6 gradient = gain * surface.gradient;
    ConstantError& error = constant_[number];
    if (error.empty() || error.back().node != node) error.push_back({node});
    error.back().gradient += robust_weight * gradient;
    // In the factor with its weight, a white error gives the gradient its covariance times that.
    taken_as_white_[node] += robust_weight * scans * gradient * gradient.transpose();
  }
}

}  // namespace paloc
