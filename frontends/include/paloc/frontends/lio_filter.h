#pragma once

#include <optional>
#include <vector>

#include "paloc/frontends/calibration_block.h"
#include "paloc/frontends/free_fall_scan.h"
#include "paloc/frontends/imu_agreement.h"
#include "paloc/frontends/lio_prediction.h"
#include "paloc/frontends/lio_state.h"
#include "paloc/frontends/place_points.h"
#include "paloc/frontends/plane_matches.h"

namespace paloc {

/// The iterated error-state Kalman filter of FAST-LIO2 (W. Xu et al., 2022, section V): state and
/// covariance, predicted with the IMU, updated with the points of a scan against planes of a local
/// map. What differs: a point moves with the velocity at the scan's end as well (see FreeFallScan),
/// so that the velocity is measured and the scan's distortion undone in the same step.
class PALOC_EXPORT LioFilter {
 public:
  struct Limits {
    int max_iterations = 8;
    double noise_floor_m = 0.005;
    double max_gate_m = 0.5;
  };

  explicit LioFilter(const Limits& limits) : limits_(limits), matches_(limits.noise_floor_m) {}

  /// Makes the calibration a part of the state, before begin(): nothing else costs anything.
  void calibrate(const CalibrationBlock& block) { calibration_ = block; }

  /// Begins at a state, with its covariance.
  void begin(const LioState& state, const LioMatrix& covariance);

  /// The same where there is a calibration and the map begins with a scan; `sensor_body` is the
  /// LiDAR's place by the recording (m).
  void begin(const LioState& state, const LioMatrix& covariance, const Vec3& sensor_body,
             const FreeFallScan& scan);

  /// Takes another state as mean, with the same covariance.
  void restart(const LioState& state) { state_ = state; }

  const LioState& state() const { return state_; }
  const LioMatrix& covariance() const { return covariance_; }
  const std::optional<CalibrationBlock>& calibration() const { return calibration_; }
  void takeTimeOffset(double most_s) { calibration_->takeTimeOffset(most_s); }

  /// The body's pose as the motions from scan to scan add up to it: that of the state, but that it
  /// is not moved by what becomes known of the calibration.
  Pose odometryPose() const;

  /// Moves on to the end of a scan. The pose before it becomes the one that motionCovariance()
  /// starts from.
  void predict(const Preintegration& imu, const ImuNoise& noise);

  /// Whether the covariance is none any more, or of a hundred metres: better to begin anew.
  bool isLost() const;

  /// Updates with a scan. `rigid`: the scan's distortion is left as it is, by a velocity of zero:
  /// where the map's is the same. Returns how many points have a plane within the gate, at the end.
  std::size_t update(const std::vector<MeasuredPoint>& points, const FreeFallScan& scan,
                     const Vec3& sensor_body, const LocalVoxelMap& map, bool rigid = false);

  /// Adds errors of these standard deviations (m, rad, m/s) to the state: of a scan that could not
  /// be undistorted.
  void blur(double position_m, double rotation_rad, double velocity_mps);

  /// Where the state puts the points of a scan; `rigid` as above. Valid until the next call.
  const std::vector<PlacedPoint>& place(const std::vector<MeasuredPoint>& points,
                                        const FreeFallScan& scan, const Vec3& sensor_body,
                                        bool rigid = false);

  /// Covariance of the motion T_0^-1 T_1 since the prediction, in the tangent space [position in
  /// body frame 0 (m), rotation on the right (rad)], T_0 as it was estimated then, or with a
  /// calibration as the last scan tells it: errors that both poses share cancel.
  ///
  /// Where IMU and scans disagree by more than they should, over the last seconds, it is as much
  /// larger.
  Mat6 motionCovariance() const;

  /// What of that motion only the IMU told (see OdometryFrame::open_motion).
  const Mat6& openMotion() const { return open_motion_; }

  /// By how much the variance of the IMU's noise was raised (see ImuAgreement).
  double imuFactor() const { return agreement_.imuFactor(); }

 private:
  std::size_t updateCalibrated(const std::vector<MeasuredPoint>& points, const FreeFallScan& scan,
                               const Vec3& sensor_body, const LocalVoxelMap& map, bool rigid);

  Limits limits_;
  PlaneMatches matches_;
  LioState state_;
  LioMatrix covariance_ = LioMatrix::Zero();
  // The pose before the last prediction, and E[error of the state now . error of that pose].
  Pose T_odom_body_0_;
  Mat6 covariance_0_ = Mat6::Zero();
  Eigen::Matrix<double, lio::kDim, 6> cross_ = Eigen::Matrix<double, lio::kDim, 6>::Zero();
  Mat6 open_motion_ = Mat6::Identity();
  ImuAgreement agreement_;
  std::vector<PlacedPoint> placed_;
  std::optional<CalibrationBlock> calibration_;
  Pose odometry_0_;  // odometryPose() before the last prediction, where there is a calibration
};

}  // namespace paloc
