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
class LioTracker : public InertialTracker {
 public:
  explicit LioTracker(const FrontendSettings& settings);

  Outcome add(const LidarFrame& frame, const ImuBuffer& imu, bool has_times) override;

  const Pose& T_odom_body() const override { return filter_.state().T_odom_body; }
  Mat6 motionCovariance() const override { return filter_.motionCovariance(); }
  Mat6 inertialMotion() const override { return filter_.inertialMotion(); }
  ScanMotion scanMotion() const override { return motionDuring(scan_, filter_.state()); }
  ScanMotion firstScanMotion() const override { return motionDuring(first_.scan, first_.state); }

  std::size_t mapBytes() const override { return map_.bytes(); }

 private:
  Outcome begin(const LidarFrame& frame, const ImuBuffer& imu, bool has_times);
  void startMoving();
  std::size_t update(bool rigid = false);
  void addToMap(const std::vector<MeasuredPoint>& points, const KeptScan& scan, bool rigid = false);
  void selectPoints(const LidarFrame& frame, bool has_times);

  LioFilter filter_;
  LocalVoxelMap map_;
  PointSelection selection_;

  KeptScan scan_;  // the last one
  bool begun_ = false;
  Vec3 sensor_body_ = Vec3::Zero();
  std::vector<MeasuredPoint> map_points_, points_;  // of the scan at hand: for the map, to register
  struct {
    KeptScan scan;
    LioState state;
    std::vector<MeasuredPoint> points;  // until the second scan
  } first_;
};

}  // namespace paloc
