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

/// What the features of a scan say of pose and velocity at its end, linearized at a state.
///
/// Tangent (9): [position (m, odom frame), rotation on the right (rad), velocity (m/s, odom
/// frame)]. The velocity is in it since the scan's distortion depends on it (see FreeFallScan).
struct FeatureMeasurement {
  LioState at;                          ///< the linearization point
  Mat9 information = Mat9::Zero();      ///< 0 along what the scan leaves open
  NullDirections<9> open{9, 0};         ///< and what that is, with the rotation on the left
  Vec9 gradient = Vec9::Zero();         ///< of half the squared residuals
  LioState found;                       ///< where prediction and scan together put the body
  std::size_t matched = 0, points = 0;  ///< features with a plane or line, at the end; features

  double matchedShare() const {
    return points == 0 ? 0 : static_cast<double>(matched) / static_cast<double>(points);
  }
};

/// Registers the features of a scan to the local map of key frames: Gauss-Newton on point-to-plane
/// and point-to-line residuals with the prediction as prior, after LOAM and LIO-SAM (T. Shan et
/// al., "LIO-SAM: Tightly-coupled Lidar Inertial Odometry via Smoothing and Mapping", 2020). What
/// noise of normals alone would say is taken out (see InformativePart).
class PALOC_EXPORT FeatureRegistration {
 public:
  struct Limits {
    int max_iterations = 8;
    double noise_floor_m = 0.005;
    double max_gate_m = 0.5;
  };

  explicit FeatureRegistration(const Limits& limits)
      : limits_(limits), planes_(limits.noise_floor_m), lines_(limits.noise_floor_m) {}

  /// `covariance` (9 x 9) of the predicted state. `rigid`: the scan's distortion is left as it is,
  /// where the map's is the same. The information is zero if there are too few matches.
  FeatureMeasurement align(const ScanFeatures& features, const FreeFallScan& scan,
                           const Vec3& sensor_body, const KeyFrameMap& map,
                           const LioState& predicted, const Mat9& covariance, bool rigid = false);

 private:
  std::size_t match(const ScanFeatures& features, const FreeFallScan& scan, const Vec3& sensor_body,
                    const KeyFrameMap& map, const LioState& x, double ageing, double gate_m);
  PointToPlaneSums<9> sums(double widening_m, double ageing);

  Limits limits_;
  PlaneMatches planes_;
  LineMatches lines_;
  std::vector<PlacedPoint> placed_;
};

}  // namespace paloc
