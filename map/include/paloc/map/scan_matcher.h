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

  /// See MapMatcher. From a rough pose: tries a fixed set of starts about it, coarse to fine, and
  /// keeps the one that the most points fit. By search: branch and bound over grids of the map
  /// (which are made at the first), positions and headings within reach of what is known. Both
  /// believe a place only when enough of the scan's points lie on the map and few rays pass through
  /// a surface of it; the search also wants it well before the second-best place.
  MapMatch locate(const Scan& scan, const StartGuess& guess) override;

  /// Time of the parts of the last match (s).
  struct Timing {
    double filter_s = 0;       ///< thinning the scan
    double association_s = 0;  ///< points to planes, over all iterations
    double solve_s = 0;        ///< residuals, weights, normal equations, steps
    double information_s = 0;  ///< patches of shared errors, directions, covariance
    double spectrum_s = 0;     ///< of the scan's own surfaces against the map's
  };
  const Timing& lastTiming() const;

 private:
  class Work;
  explicit ScanMatcher(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

}  // namespace paloc
