#pragma once

#include <string>
#include <vector>

#include "inertial_tracker.h"
#include "paloc/frontends/feature_registration.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/inertial_smoother.h"
#include "paloc/frontends/point_selection.h"
#include "paloc/frontends/ring_features.h"

namespace paloc {

/// Odometry of the LIO-SAM family (T. Shan et al., 2020), scan by scan: edge and plane features,
/// registered to a local map of key frames, in a fixed-lag smoother with the IMU.
///
/// Start: as LioTracker's, the second scan is registered to the first with the same distortion,
/// which tells the velocity. The first key frame is then placed anew with what the smoother knows
/// of that velocity, for as long as the first scan is in its window.
class LioSamTracker : public InertialTracker {
 public:
  explicit LioSamTracker(const FrontendSettings& settings);

  Outcome add(const LidarFrame& frame, const ImuBuffer& imu, bool has_times) override;

  const Pose& odometryPose() const override { return smoother_.state().T_odom_body; }
  Mat6 motionCovariance() const override { return smoother_.motionCovariance(); }
  Mat6 openMotion() const override { return smoother_.openMotion(); }
  ScanMotion scanMotion() const override { return motionDuring(scan_, smoother_.state()); }
  ScanMotion firstScanMotion() const override { return motionDuring(first_.scan, first_.state); }

  std::size_t mapBytes() const override { return map_.bytes(); }
  LidarColumns columns() const override;
  std::vector<std::string> notes(int scans) const override;

 private:
  Outcome begin(const LidarFrame& frame, const ImuBuffer& imu);
  Vec9 blur() const;
  void predict();
  void startMoving();
  void settleFirst();
  void placeFirst(const LioState& x);
  FeatureMeasurement align(bool rigid = false);
  void extractFeatures(const LidarFrame& frame, bool has_times);
  void considerKeyFrame(const FeatureMeasurement& measured);
  void addKeyFrame(bool rigid = false);

  RingFeatures rings_;
  PointSelection selection_;
  FeatureRegistration registration_;
  InertialSmoother smoother_;
  KeyFrameMap map_;

  KeptScan scan_;  // the last one
  bool begun_ = false;
  Vec3 sensor_body_ = Vec3::Zero();
  ScanFeatures map_features_, features_;  // of the scan at hand: for the map, to register
  std::vector<PlacedPoint> placed_planes_, placed_edges_;
  Pose last_key_frame_;
  int open_here_ = 0;  // key frames since the body was elsewhere, for what they leave open
  InertialStart start_;
  struct {
    KeptScan scan;
    LioState state;
    ScanFeatures features;
    bool moving = false;
    int scans_since = 0;
  } first_;
  int scans_with_rings_ = 0, scans_without_rings_ = 0;
};

}  // namespace paloc
