#pragma once

#include <vector>

#include "paloc/frontends/free_fall_scan.h"
#include "paloc/frontends/key_frame_map.h"
#include "paloc/frontends/line_matches.h"
#include "paloc/frontends/lio_state.h"
#include "paloc/frontends/place_points.h"
#include "paloc/frontends/plane_matches.h"

namespace paloc {

/// The features of a scan, as measured.
struct ScanFeatures {
  std::vector<MeasuredPoint> planes, edges;
};

/// What the features of a scan say of pose and velocity at its end, linearized where they are
/// found.
///
/// Tangent (9): [position (m, odom frame), rotation on the right (rad), velocity (m/s, odom
/// frame)]. The velocity is in it since the scan's distortion depends on it (see FreeFallScan).
struct FeatureMeasurement {
  LioState found;                       ///< where prediction and scan together put the body
  Mat9 information = Mat9::Zero();      ///< of the scan alone; 0 along what it leaves open
  NullDirections<9> open{9, 0};         ///< and what that is
  Vec9 gradient = Vec9::Zero();         ///< of half the squared residuals, at `found`
  std::size_t matched = 0, points = 0;  ///< features with a plane or line, at the end; features

  double matchedShare() const {
    return points == 0 ? 0 : static_cast<double>(matched) / static_cast<double>(points);
  }
};

/// Registers the features of a scan to the local map of key frames: planes and lines after LOAM and
/// LIO-SAM (T. Shan et al., "LIO-SAM: Tightly-coupled Lidar Inertial Odometry via Smoothing and
/// Mapping", 2020), with the prediction as prior, by the same iterated update as that of LioFilter.
class PALOC_EXPORT FeatureRegistration {
 public:
  struct Limits {
    int max_iterations = 8;
    double noise_floor_m = 0.005;
    double max_gate_m = 0.5;
  };

  explicit FeatureRegistration(const Limits& limits)
      : limits_(limits), planes_(limits.noise_floor_m), lines_(limits.noise_floor_m) {}

  /// `covariance` of the predicted state. `rigid`: the scan's distortion is left as it is, where
  /// the map's is the same. The information is zero if there are too few matches.
  FeatureMeasurement align(const ScanFeatures& features, const FreeFallScan& scan,
                           const Vec3& sensor_body, const KeyFrameMap& map,
                           const LioState& predicted, const LioMatrix& covariance,
                           bool rigid = false);

 private:
  Limits limits_;
  PlaneMatches planes_;
  LineMatches lines_;
  std::vector<PlacedPoint> placed_;
};

}  // namespace paloc
