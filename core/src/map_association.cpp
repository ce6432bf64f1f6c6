#include "paloc/core/map_association.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "paloc/core/match_plausibility.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/relocation.h"

namespace paloc {

MapAssociation KeptScans::associate(const MapMatch& match, const Pose& T_map_body_guess) {
  MapAssociation association{match.thinned, T_map_body_guess, match};
  association.match.thinned.reset();
  if (!association.scan) return association;
  const bool fully_used =
      match.accepted() && std::all_of(match.directions.begin(), match.directions.end(),
                                      [](const MatchDirection& direction) {
                                        return direction.cls == DirectionClass::kFull;
                                      });
  const double megabytes =
      1e-6 * static_cast<double>(sizeof(Point3f) * association.scan->points_body.size() +
                                 sizeof(std::uint16_t) * association.scan->returns.size());
  if (fully_used && kept_mb_ + megabytes > limit_mb_) {
    association.scan.reset();
  } else {
    kept_mb_ += megabytes;
  }
  return association;
}

bool associateAnew(MapMatcher& matcher, const EstimatorSettings& settings, const Pose& T_map_body,
                   const Mat6& covariance, MapAssociation& association, RematchCounts& counts) {
  const Vec6 moved = boxminus(T_map_body, association.T_map_body_guess);
  if (moved.head<3>().norm() <= settings.rematch_position_m &&
      moved.tail<3>().norm() <= settings.rematch_rotation_rad) {
    return false;
  }
  // The map is wrong there: however unsure the pose is in the end, such a match is no help.
  if (association.match.refusal == MatchRefusal::kContradiction) return false;
  // Registration alone finds something near any pose.
  if (!association.match.accepted() && Relocation::lost(covariance)) return false;
  if (!association.scan) {
    ++counts.not_kept;
    return false;
  }
  ++counts.tried;
  const bool accepted_before = association.match.accepted();
  const double sigma_position = std::sqrt(std::max(0.0, covariance.diagonal().head<3>().sum()));
  const double sigma_rotation = std::sqrt(std::max(0.0, covariance.diagonal().tail<3>().sum()));
  association.match =
      matcher.match(*association.scan, toMrpt(T_map_body), sigma_position, sigma_rotation);
  association.match.thinned.reset();
  association.T_map_body_guess = T_map_body;
  const double limit = settings.max_innovation_sigmas;
  if (association.match.accepted() &&
      innovationSquare(association.match, T_map_body, covariance) > limit * limit) {
    association.match.refusal = MatchRefusal::kContradiction;
  }
  const bool accepted = association.match.accepted();
  counts.gained += accepted && !accepted_before ? 1 : 0;
  counts.withdrawn += !accepted && accepted_before ? 1 : 0;
  return accepted || accepted_before;
}

}  // namespace paloc
