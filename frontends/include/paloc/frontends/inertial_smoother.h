#pragma once

#include <optional>

#include "paloc/core/fixed_lag_smoother.h"
#include "paloc/core/preintegration.h"
#include "paloc/frontends/feature_registration.h"
#include "paloc/frontends/imu_agreement.h"

namespace paloc {

/// What is known at the start, beyond the pose, as standard deviations of each axis.
struct InertialStart {
  double sigma_velocity_mps = 1.5;
  double sigma_acceleration_mps2 = 2;  ///< of the body, while the mean force told where up is
  double sigma_bias_acc_mps2 = 0.1;
  double sigma_bias_gyro_radps = 0.01;
};

/// The state of a LiDAR-inertial odometry on the estimator's own smoother: a node at the end of
/// each scan, IMU and bias-walk factors between them, gravity of known length that all share, and
/// what each scan measured of pose and velocity. The odom frame stands for the map's of State.
///
/// Along directions that a scan leaves open the node is to stay as it was predicted (see
/// ConsiderUpdate); beside other scans of the window, the smoother would estimate it there as well.
/// So the window ends with such a scan: the newest node is as the update has it, and the next
/// window begins there.
class PALOC_EXPORT InertialSmoother {
 public:
  /// `gravity_mps2`: the local strength of gravity.
  InertialSmoother(double lag_s, double gravity_mps2);

  /// Begins at a state that follows from a first scan, in a new window.
  void begin(TimeNs t_ns, const LioState& state, const InertialStart& start);

  /// Predicts the state after the motion that an IMU measured.
  void predict(const Preintegration& imu, const ImuNoise& noise);
  const LioState& predicted() const { return predicted_; }
  LioMatrix predictedCovariance() const;

  /// Adds the node predicted, with what a scan that was registered with this prediction says there;
  /// its information may be zero. Unless it is blurred, the newest node is then where the scan was
  /// found, with the covariance that the registration's update has. `blur`: variances of errors of
  /// the scan (9), of which its own information knows nothing. The step that the scan makes tells
  /// of the IMU's noise if `compare`.
  void add(TimeNs t_ns, const FeatureMeasurement& scan, const Vec9& blur, bool compare);

  /// The newest node.
  const LioState& state() const { return state_; }
  LioMatrix covariance() const;
  /// The node of a time, as later scans see it; nothing if it has left the window.
  std::optional<LioState> smoothed(TimeNs t_ns) const;

  /// Whether the covariance is none any more, or of a hundred metres: better to begin anew.
  bool isLost() const;
  /// Of the motion from the node before to the newest, each as it was when it was the newest.
  Mat6 motionCovariance() const;
  /// What of that motion only the IMU told (see OdometryFrame::open_motion).
  const Mat6& openMotion() const { return open_motion_; }
  double imuFactor() const { return agreement_.imuFactor(); }

 private:
  void beginWindow(TimeNs t_ns, const State& state, const StateMatrix& covariance);
  void takeNewest();
  void holdLengthOfGravity();

  double gravity_mps2_;
  SmootherSettings settings_;
  FixedLagSmoother smoother_;
  ImuAgreement agreement_;
  bool open_ = false;  // the newest scan left directions open
  TimeNs t_ns_ = 0;    // of the newest node
  State node_;         // it, and what is told of it
  LioState state_;
  StateMatrix covariance_ = StateMatrix::Zero();
  // The prediction from it.
  ChainNode next_;
  LioState predicted_;
  StateMatrix covariance_predicted_ = StateMatrix::Zero();
  StateMatrix cross_ = StateMatrix::Zero();  // E[error of the next . error of the newest]
  Mat6 motion_covariance_ = Mat6::Zero(), open_motion_ = Mat6::Identity();
};

}  // namespace paloc
