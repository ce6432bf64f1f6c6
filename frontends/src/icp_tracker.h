#pragma once

#include <vector>

#include "paloc/frontends/icp_filter.h"
#include "paloc/frontends/point_selection.h"
#include "paloc/frontends/scan_tracker.h"

namespace paloc {

/// LiDAR odometry, scan by scan: the filter, the local map that scans are registered to, and the
/// start.
///
/// Start: the motion during the first scan is not known, so it goes into the map with its
/// distortion. The second one is registered with its own, which is nearly the same: two scans
/// distorted alike are apart by the motion between them. Then the map of the first is made anew
/// with that, and the second registered as all others are. Where no scan could be registered for
/// longer than a pause may last, the odometry begins anew.
class IcpTracker : public ScanTracker {
 public:
  explicit IcpTracker(const FrontendSettings& settings);

  Outcome add(const LidarFrame& frame, const ImuBuffer& imu, bool has_times) override;

  const Pose& odometryPose() const override { return filter_.state().T_odom_body; }
  Mat6 motionCovariance() const override { return filter_.motionCovariance(); }
  Mat6 openMotion() const override { return filter_.openMotion(); }
  ScanMotion scanMotion() const override { return motionDuring(scan_, filter_.state()); }
  ScanMotion firstScanMotion() const override { return motionDuring(first_.scan, first_.state); }
  bool usesImu() const override { return false; }
  std::size_t mapBytes() const override { return map_.bytes(); }
  std::string whyRefused() const override { return "no point within range"; }
  std::string whoseMotionWhereCoasted() const override { return "a guess"; }
  std::string need() const override { return "needs a scan with points within range"; }

 private:
  struct KeptScan {  ///< what of a scan is needed
    TimeNs start_ns = 0, end_ns = 0;
  };

  Outcome begin();
  void startMoving();
  std::size_t update(bool rigid = false);
  /// Where a direction is told by few points, again with all that tell it: which these are, the
  /// first update tells.
  std::size_t updateWithMorePoints();
  std::size_t registrationPoints() const {
    return static_cast<std::size_t>(settings_.local_map.registration_points);
  }
  void addToMap(const std::vector<MeasuredPoint>& points, bool rigid = false);
  static ScanMotion motionDuring(const KeptScan& scan, const ChordMotion& state);

  FrontendSettings settings_;
  IcpFilter filter_;
  LocalVoxelMap map_;
  PointSelection selection_;
  std::vector<MeasuredPoint> map_points_, points_;  // of the scan at hand: for the map, to register

  KeptScan scan_;          // the last one
  TimeNs tracked_ns_ = 0;  // end of the last one that was registered
  bool begun_ = false;
  Vec3 sensor_body_ = Vec3::Zero();
  struct {
    KeptScan scan;
    ChordMotion state;
    std::vector<MeasuredPoint> points;  // until the second scan
  } first_;
};

}  // namespace paloc
