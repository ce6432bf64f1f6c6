#pragma once

#include <span>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/map_factor.h"
#include "paloc/core/map_matcher.h"

namespace paloc {

// Scans near each other see the same surfaces with the same errors of the map. Along the way these
// errors are taken as a Gauss-Markov process: correlated by exp(-d / L) over a way of d. A smoother
// takes factors as independent; white noise of N times the variance has the same effect on an
// average as errors that N = sum_j exp(-d_kj / L) scans share (its power at frequency zero). So
// each scan's factor gets its own errors once and the shared ones N times. While the platform
// stands, N grows with each scan: together they say what one of them does.

/// Counts, in order of time, how many scans share the errors of the newest one, when those to come
/// are not known yet: as many again as those before it. Before the first one a walk at 1 m/s is
/// taken.
class PALOC_EXPORT ScanCorrelation {
 public:
  explicit ScanCorrelation(double distance_m) : distance_m_(distance_m) {}

  /// The next scan that gives a map factor, its position in the map (m) and the time since the node
  /// before it (s); how many scans share its errors, at least 1.
  double add(const Vec3& position_map, double since_last_s);

 private:
  double distance_m_;
  double before_ = 0;  // of the last scan: the scans up to it, by their correlation
  Vec3 anchor_ = Vec3::Zero();
};

/// The same when all are known: of each node along the way, by its position in the map (m); nodes
/// that give no map factor share nothing and have 1.
PALOC_EXPORT std::vector<double> scansSharingErrors(std::span<const Vec3> positions_map,
                                                    const std::vector<bool>& has_map_factor,
                                                    double distance_m);

/// The map factor of a match whose shared errors are those of `scans` scans, with Huber's kernel of
/// `robust_width` standard deviations. The width refers to a scan on its own: a single bad one
/// must not hide behind its small weight.
PALOC_EXPORT MapFactor mapFactorOf(const MapMatch& match, double scans, double robust_width);

/// By how much the covariance of a match among `scans` scans that share its errors is larger than
/// that of a scan on its own, on the average over what it knows; from 1 up to `scans`.
PALOC_EXPORT double scansForOne(const MapMatch& match, double scans);

/// The map factor of a match in a recording that is smoothed as a whole, where the shared errors
/// are considered afterwards (SurfaceErrors): it has the information of a scan on its own, divided
/// by scansForOne(). The one above is strongest along the differences of poses that no shared error
/// changes; there the errors that nobody knows of decide (a plane fitted across an edge, the same
/// in every scan that sees it), and the mean of all scans then lies further off than most.
PALOC_EXPORT MapFactor mapFactorOfOneAmong(const MapMatch& match, double scans,
                                           double robust_width);

}  // namespace paloc
