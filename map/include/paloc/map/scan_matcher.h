#pragma once

#include <memory>

#include "paloc/core/export.h"
#include "paloc/core/map_matcher.h"
#include "paloc/map/matcher_settings.h"
#include "paloc/map/prior_map.h"

namespace paloc {

/// Registers scans to a prior map: point-to-plane Gauss-Newton with a robust kernel, information
/// under shared errors, directions classed and scaled (design, section 4). One object serves one
/// caller at a time; the map may be shared. The same scan and guess give the same bytes on any
/// number of threads.
class PALOC_EXPORT ScanMatcher : public MapMatcher {
 public:
  static std::shared_ptr<ScanMatcher> onto(std::shared_ptr<const PriorMap> map,
                                           const MatcherSettings& settings);
  ~ScanMatcher() override;

  /// See MapMatcher. Sigmas of 0 leave only the floors of the settings.
  MapMatch match(const Scan& scan, const mrpt::poses::CPose3D& T_map_body_guess,
                 double guess_sigma_position, double guess_sigma_rotation) override;

  /// See MapMatcher. Tries a fixed set of starts about the rough pose, coarse to fine, keeps the
  /// one that the most points fit, and believes it only when enough points lie on their planes and
  /// few rays pass through a surface of the map.
  MapMatch locate(const Scan& scan, const mrpt::poses::CPose3D& T_map_body_rough) override;

  /// Time of the parts of the last match (s).
  struct Timing {
    double filter_s = 0;       ///< thinning the scan
    double association_s = 0;  ///< points to planes, over all iterations
    double solve_s = 0;        ///< residuals, weights, normal equations, steps
    double information_s = 0;  ///< patches of shared errors, directions, covariance
  };
  const Timing& lastTiming() const;

 private:
  class Work;
  explicit ScanMatcher(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

}  // namespace paloc
