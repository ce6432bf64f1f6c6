#pragma once

#include <cstdint>
#include <vector>

#include "paloc/map/map_changes.h"
#include "ray_targets.h"

namespace paloc {

/// What the scans say of one target.
struct RayVotes {
  std::uint16_t passes = 0;  ///< scans that see through it
  std::uint16_t hits = 0;    ///< scans that see it
  TimeNs first_hit_ns = 0, last_hit_ns = 0;
};

/// How far off something must be to lie beyond all noise, at the end of a ray or on the way to it.
class ChangeMargins {
 public:
  ChangeMargins(const ChangeSettings& settings, const ChangeNoise& noise)
      : settings_(settings), noise_(noise) {}

  const ChangeSettings& settings() const { return settings_; }
  bool usable(const ScanRays& scan) const {
    return scan.position_sigma_m <= settings_.max_position_sigma_m;
  }
  /// Three standard deviations of the distance between a map point at `range_m` and a return, along
  /// a direction whose cosine with the ray is `cosine`.
  double noise(const ScanRays& scan, double range_m, double cosine) const;

 private:
  ChangeSettings settings_;
  ChangeNoise noise_;
};

/// Every usable scan votes on every target.
std::vector<RayVotes> castVotes(const RayTargets& targets, const ScanRaySource& scans,
                                const ChangeMargins& margins, int threads);

/// Votes summed over the targets on the same surface about each target.
struct VoteSums {
  std::uint32_t passes = 0, hits = 0;
  std::uint32_t most_passes = 0;  ///< of any one of them: so many scans at least
};
std::vector<VoteSums> sumAbout(const RayTargets& targets, const std::vector<RayVotes>& votes,
                               int threads);

}  // namespace paloc
