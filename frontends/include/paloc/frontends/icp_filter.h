#pragma once

#include <vector>

#include "paloc/frontends/chord_motion.h"
#include "paloc/frontends/measured_point.h"
#include "paloc/frontends/plane_matches.h"

namespace paloc {

/// Registers scans to a local map without an IMU: point-to-plane ICP in the form of an iterated
/// error-state Kalman filter, so that the motion before says what to expect of the next, and
/// directions that the scan does not tell go on as they were.
///
/// Pose, velocities and the bend of the way are found together: a scan is distorted by the motion
/// during it, and a chord joins it to the pose at the end of the scan before (after CT-ICP: P.
/// Dellenbach et al., 2022, with their two poses a scan, and without a bend).
class PALOC_EXPORT IcpFilter {
 public:
  struct Limits {
    int max_iterations = 20;
    double noise_floor_m = 0.005;
    double max_gate_m = 0.5;
  };
  /// Standard deviation of the change of the mean velocity from scan to scan, a second.
  struct Unevenness {
    double acceleration_mps2 = 2;
    double angular_acceleration_radps2 = 4;
  };

  IcpFilter(const Limits& limits, const Unevenness& unevenness)
      : limits_(limits), matches_(limits.noise_floor_m), unevenness_(unevenness) {}

  /// Begins at a state, with its covariance.
  void begin(const ChordMotion& state, const ChordMatrix& covariance);
  /// Takes another state as mean, with the same covariance.
  void restart(const ChordMotion& state) { state_ = state; }

  const ChordMotion& state() const { return state_; }
  const ChordMatrix& covariance() const { return covariance_; }

  /// Goes on for `dt_s` as it was. The pose before it becomes the one that motionCovariance()
  /// starts from.
  void predict(double dt_s);

  /// Whether the covariance is none any more, or of a hundred metres: better to begin anew.
  bool isLost() const;

  /// Updates with a scan. `rigid`: the scan is taken without distortion: where the map's is the
  /// same. Returns how many points have a plane within the gate, at the end; 0 where the
  /// registration did not settle: then the state is its best guess, no surer than the prediction.
  std::size_t update(const std::vector<MeasuredPoint>& points, const Vec3& sensor_body,
                     const LocalVoxelMap& map, bool rigid = false);
  /// Takes the last update back.
  void takeBack();
  /// Sum of n n^T over the planes' normals that the points of the last update had.
  Mat3 normals() const { return matches_.normals(); }

  /// Where the state puts the points of a scan; `rigid` as above. Valid until the next call.
  const std::vector<PlacedPoint>& place(const std::vector<MeasuredPoint>& points,
                                        const Vec3& sensor_body, bool rigid = false);

  /// Covariance of the motion T_0^-1 T_1 since the prediction, in the tangent space [position in
  /// body frame 0 (m), rotation on the right (rad)], T_0 as it was estimated then.
  Mat6 motionCovariance() const;
  /// What of that motion no scan told, but the prediction (see OdometryFrame::open_motion).
  const Mat6& openMotion() const { return open_motion_; }

 private:
  using Cross = Eigen::Matrix<double, chord::kDim, 6>;

  /// Of the pose, in a second squared of the unevenness.
  void addMisfit(double misfit_s2);
  void placePoints(const std::vector<MeasuredPoint>& points, const Vec3& sensor_body,
                   const ChordMotion& x, double ageing);

  Limits limits_;
  PlaneMatches matches_;
  Unevenness unevenness_;
  ChordMotion state_;
  ChordMatrix covariance_ = ChordMatrix::Zero();
  double dt_s_ = 0;  // of the last prediction
  // The pose before it, and E[error of the state now . error of that pose].
  Pose T_odom_body_0_;
  Mat6 covariance_0_ = Mat6::Zero(), open_motion_ = Mat6::Identity();
  Cross cross_ = Cross::Zero();
  struct {
    ChordMotion state;
    ChordMatrix covariance = ChordMatrix::Zero();
    Cross cross = Cross::Zero();
  } before_update_;
  std::vector<PlacedPoint> placed_;
};

}  // namespace paloc
