#include "paloc/core/surface_errors.h"

#include <algorithm>

#include "paloc/core/direction_information.h"
#include "paloc/core/map_correlation.h"
#include "paloc/core/shared_errors.h"

namespace paloc {

void SurfaceErrors::add(std::size_t node, const MapMatch& match, double scans,
                        double robust_weight) {
  if (robust_weight <= 0) return;
  // Of mapFactorOfOneAmong(). An error does not move the match along what is not known.
  const double for_one = scansForOne(match, scans);
  const Mat6 gain = gainUnderSharedErrors(match.information, match.shared_spread) *
                    projectorOntoKnown(match.information) / for_one;
  Mat6 varying = match.shared_spread;
  if (match.surfaces) {
    for (const SurfaceGradient& surface : *match.surfaces) {
      const Vec6 shift = match.surface_bias_m * surface.gradient;
      varying -= shift * shift.transpose();
      addTo(static_cast<std::size_t>(surface.surface), node, robust_weight * gain * shift);
    }
  }
  const Mat6 white = gain * (match.information + scans * varying) * gain.transpose();
  taken_as_white_[node] += robust_weight * (match.informationAmong(1) / for_one - white);
}

void SurfaceErrors::addTo(std::size_t surface, std::size_t node, const Vec6& gradient) {
  constant_.resize(std::max(constant_.size(), surface + 1));
  ConstantError& error = constant_[surface];
  if (error.empty() || error.back().node != node) error.push_back({node});
  error.back().gradient += gradient;
}

}  // namespace paloc
