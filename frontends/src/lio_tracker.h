#pragma once

#include <optional>
#include <vector>

#include "paloc/core/stage_timer.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/lidar_frame.h"
#include "paloc/frontends/lio_filter.h"
#include "paloc/frontends/scan_motion.h"
#include "paloc/map/scan_thinning.h"

namespace paloc {

/// LiDAR-inertial odometry, scan by scan: the filter, the local map that it is updated against, and
/// the start.
///
/// Start: the first scan's velocity is not known, so it goes into the map with its distortion. The
/// second one is registered with its own, which is nearly the same: two scans distorted alike are
/// apart by exactly v dt. Then the map of the first is made anew and the second registered as all
/// others are. So it does not matter whether the body is at rest.
class LioTracker {
 public:
  explicit LioTracker(const FrontendSettings& settings);

  void setStageTimer(StageTimer* timer) { timer_ = timer; }

  enum class Outcome {
    kTracked,
    kCoasted,    ///< too few points on the local map: the state is predicted
    kBegun,      ///< the first scan of a stretch: the motion since the last frame is not known
    kNoInertia,  ///< not begun, since the IMU does not cover the scan
  };

  /// `has_times`: the points' times are to be used. The scan is later than all before.
  Outcome add(const LidarFrame& frame, const ImuBuffer& imu, bool has_times);

  const LioState& state() const { return filter_.state(); }
  const LioMatrix& covariance() const { return filter_.covariance(); }
  /// Of the motion since the last frame (see OdometryFrame).
  Mat6 motionCovariance() const { return filter_.motionCovariance(); }

  /// How the body moved during the scan that was added last, in poses of the odom frame.
  ScanMotion scanMotion() const { return motionDuring(scan_, state()); }
  /// The same of the first scan, once the second was added.
  ScanMotion firstScanMotion() const { return motionDuring(first_.scan, first_.state); }

  std::size_t mapBytes() const { return map_.bytes(); }
  /// How much noisier than the settings say the IMU was taken to be (standard deviation), at most.
  double worstImuNoise() const { return worst_imu_noise_; }
  int intervalsWithoutImu() const { return intervals_without_imu_; }

 private:
  struct KeptScan {  ///< what of a scan is needed
    TimeNs start_ns = 0, end_ns = 0;
    std::optional<FreeFallScan> fall;
  };

  Outcome begin(const LidarFrame& frame, const ImuBuffer& imu, bool has_times);
  void predict(const LidarFrame& frame, const ImuBuffer& imu);
  void startMoving();
  std::size_t update(bool rigid = false);
  void addToMap(const std::vector<MeasuredPoint>& points, const KeptScan& scan, bool rigid = false);
  void selectPoints(const LidarFrame& frame, bool has_times);
  static ScanMotion motionDuring(const KeptScan& scan, const LioState& state);

  FrontendSettings settings_;
  LioFilter filter_;
  LocalVoxelMap map_;
  ScanThinning thinning_;
  StageTimer* timer_ = nullptr;

  KeptScan scan_;  // the last one
  bool begun_ = false;
  Vec3 sensor_body_ = Vec3::Zero();
  std::vector<MeasuredPoint> map_points_, points_;  // of the scan at hand: for the map, to register
  struct {
    KeptScan scan;
    LioState state;
    std::vector<MeasuredPoint> points;  // until the second scan
  } first_;
  bool inertial_ = true;                // the IMU covers the last scan and the way to it
  Vec3 last_rate_body_ = Vec3::Zero();  // as measured (rad/s), before a gap of the IMU
  double worst_imu_noise_ = 1;
  int intervals_without_imu_ = 0;
};

}  // namespace paloc
