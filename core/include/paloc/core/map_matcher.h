#pragma once

#include <mrpt/poses/CPose3D.h>

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/scan.h"
#include "paloc/core/shared_errors.h"
#include "paloc/core/start_guess.h"

namespace paloc {

/// What the map says of one direction of the pose.
enum class DirectionClass { kFull, kPartial, kNone };

/// One of the six directions of a match: three of position, three of rotation.
struct MatchDirection {
  Vec3 axis_body = Vec3::Zero();  ///< unit vector in the body frame: of translation or of rotation
  DirectionClass cls = DirectionClass::kNone;
  double share = 0;  ///< correspondences that constrain it over those of the best direction, 0..1
  double agreement = 0;    ///< of the information along it, what robust weights leave, 0..1
  double probability = 0;  ///< that its information stands out of the noise, 0..1
  double sigma = 0;        ///< standard deviation along it given the others free (m or rad)
};

/// Why a scan gave no map factor.
enum class MatchRefusal {
  kNone,
  kNotTried,  ///< there was a scan, but nothing to start from
  kNoScan,
  kTooFewPoints,
  kOutsideMap,
  kTooFewInliers,
  kLowOverlap,
  kHighResidual,
  kLargeStep,
  kNotConverged,
  kNotVerified,
  kMapContradicts,    ///< of a start: the map shows other things there: another place or storey
  kContradiction,     ///< to what IMU, odometry and earlier matches say
  kNoPlaceFound,      ///< a search: the scan fits nowhere in the map
  kAmbiguous,         ///< a search: it fits more than one place, or one place in more than one way
  kSearchUnfinished,  ///< a search: given up before everything was looked at
  kNotConfirmed,      ///< a start found by search, which the scans that followed did not bear out
};

/// One or two words for tables ("low overlap").
PALOC_EXPORT std::string toString(MatchRefusal refusal);

/// What a surface of the map does to a scan that lies on it, should the surface be shifted.
struct SurfaceGradient {
  int surface = 0;  ///< its number: the same in all matches of one matcher
  /// Y = sum J/D over the scan's points on it: by so much a shift of 1 m along the normal changes
  /// the gradient of the match (shared_errors.h; the information's units times m).
  Vec6 gradient = Vec6::Zero();
};

/// The answer of a prior map to a scan.
struct MapMatch {
  MatchRefusal refusal = MatchRefusal::kNotConverged;
  mrpt::poses::CPose3D T_map_body;
  /// Information (6 x 6) of the pose if no points shared errors: tangent [position in the map
  /// frame, rotation on the right], 1/m2, 1/(m rad), 1/rad2. Rank-deficient where the map does not
  /// fix a direction.
  Mat6 information = Mat6::Zero();
  /// What the errors that points share add to the covariance of the gradient (shared_errors.h), in
  /// the units of the information, and zero where that is.
  Mat6 shared_spread = Mat6::Zero();
  /// The surfaces that matter, and the standard deviation (m) of the shift of each, which is the
  /// same in every scan that lies on it; it is in `shared_spread`, too. Null if there are none.
  std::shared_ptr<const std::vector<SurfaceGradient>> surfaces;
  double surface_bias_m = 0;
  std::array<MatchDirection, 6> directions;  ///< 0..2 position, 3..5 rotation

  /// How much the scan's own surfaces disagree with the map's on what is fixed (D_e, without unit,
  /// see spectrumDifference()); NaN where it was not computed. It is reported and decides nothing.
  double spectrum = std::numeric_limits<double>::quiet_NaN();

  int points = 0;                ///< points of the filtered scan that were tried
  int matched = 0;               ///< points that found a plane of the map
  int inliers = 0;               ///< matched points whose residual lies within the gate
  double overlap = 0;            ///< matched over tried, 0..1
  double residual_rms_m = 0;     ///< of the inliers
  double residual_median_m = 0;  ///< of the absolute residuals of the matched
  int iterations = 0;
  bool searched = false;  ///< found by search, not by registration from a rough pose
  double explained = 0;   ///< of a start: share of the points tried that lie on the map's surfaces
  double blocked = 0;     ///< of a start: share of the rays that pass through surfaces of the map
  double contradicted =
      0;                 ///< of a start: share of the points where the map has nothing, but ground
  double runner_up = 0;  ///< of a search: `explained` less the two of the second-best place
  /// The points that were tried, enough to match the scan again; null if there is no such need.
  std::shared_ptr<const Scan> thinned;

  bool accepted() const { return refusal == MatchRefusal::kNone; }

  /// Information of the pose under shared errors. Among `scans` scans that share them (1 or more),
  /// each can be taken as independent of the others with this one (map_correlation.h).
  Mat6 informationAmong(double scans) const {
    return informationUnderSharedErrors(information, scans * shared_spread);
  }
};

/// Port: a prior map that scans are registered to. Implemented in map/.
class PALOC_EXPORT MapMatcher {
 public:
  virtual ~MapMatcher() = default;

  /// Registers a scan from a good guess (a prediction: centimetres, tenths of a degree).
  /// `guess_sigma_position` (m) and `guess_sigma_rotation` (rad) bound the step that is believed.
  virtual MapMatch match(const Scan& scan, const mrpt::poses::CPose3D& T_map_body_guess,
                         double guess_sigma_position, double guess_sigma_rotation) = 0;

  /// Finds a scan in the map, and verifies what it finds before it is believed: a refusal says why
  /// it is not. From a rough pose within about 1 m and 10 degrees by registration; from one worse
  /// than that, from a position, or from nothing by a search.
  virtual MapMatch locate(const Scan& scan, const StartGuess& guess) = 0;
};

}  // namespace paloc
