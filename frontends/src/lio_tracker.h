#pragma once

#include <vector>

#include "inertial_tracker.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/lio_filter.h"
#include "paloc/frontends/point_selection.h"

namespace paloc {

/// LiDAR-inertial odometry, scan by scan: the filter, the local map that it is updated against, and
/// the start.
///
/// Start: the first scan's velocity is not known, so it goes into the map with its distortion. The
/// second one is registered with its own, which is nearly the same: two scans distorted alike are
/// apart by exactly v dt. Then the map of the first is made anew and the second registered as all
/// others are. So it does not matter whether the body is at rest.
///
/// With a calibration, the map hangs on the LiDAR, and what becomes known of where that sits moves
/// the body against it. Scans are handed on with the mounting as it is known with them, and their
/// motion by the LiDAR's clock. What the map had of scans before stays as it is.
class LioTracker : public InertialTracker {
 public:
  explicit LioTracker(const FrontendSettings& settings);

  Outcome add(const LidarFrame& frame, const ImuBuffer& imu, bool has_times) override;

  const Pose& odometryPose() const override { return T_odom_body_; }
  Mat6 motionCovariance() const override { return filter_.motionCovariance(); }
  Mat6 openMotion() const override { return filter_.openMotion(); }
  ScanMotion scanMotion() const override { return motionOf(scan_, filter_.state()); }
  ScanMotion firstScanMotion() const override { return motionOf(first_.scan, first_.state); }
  TimeNs imuLateNs() const override { return imu_late_ns_; }
  Pose mountOf(const Pose& T_body_lidar) const override;
  std::vector<std::string> notes(int scans) const override;

  std::size_t mapBytes() const override { return map_.bytes(); }

 private:
  Outcome track(const LidarFrame& frame, const ImuBuffer& imu, bool has_times);
  Outcome begin(const LidarFrame& frame, const ImuBuffer& imu, bool has_times);
  void startMoving();
  std::size_t update(bool rigid = false);
  void addToMap(const std::vector<MeasuredPoint>& points, const KeptScan& scan, bool rigid = false);
  void selectPoints(const LidarFrame& frame, bool has_times);
  ScanMotion motionOf(const KeptScan& scan, const LioState& x) const;
  void shiftStamps(double scan_interval_s);

  LioFilter filter_;
  LocalVoxelMap map_;
  PointSelection selection_;

  KeptScan scan_;  // the last one
  bool begun_ = false;
  Pose T_body_lidar_;  // by the recording
  Pose T_odom_body_;
  TimeNs imu_late_ns_ = 0;                          // as far as it is known and put right
  std::vector<MeasuredPoint> map_points_, points_;  // of the scan at hand: for the map, to register
  struct {
    KeptScan scan;
    LioState state;
    std::vector<MeasuredPoint> points;  // until the second scan
  } first_;
};

}  // namespace paloc
