#pragma once

#include <optional>

#include "paloc/frontends/free_fall_scan.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/lidar_frame.h"
#include "paloc/frontends/lio_state.h"
#include "paloc/frontends/scan_motion.h"

namespace paloc {

/// When a scan began and ended, by the IMU's clock.
struct ScanTimes {
  TimeNs start_ns = 0, end_ns = 0;
};
inline ScanTimes timesOf(const LidarFrame& frame, TimeNs imu_late_ns = 0) {
  return {frame.stamp_ns + imu_late_ns, frame.endNs() + imu_late_ns};
}

/// A scan's time, and how the IMU says that the body moved during it.
struct KeptScan : ScanTimes {
  std::optional<FreeFallScan> fall;
};

/// How the body moved during a scan, in poses of the odom frame; `x` is the state at its end.
ScanMotion motionDuring(const KeptScan& scan, const LioState& x);

/// The first scan of a stretch. The body's acceleration is taken as zero.
struct FirstScan {
  KeptScan scan;
  Vec3 up_body = Vec3::UnitZ();  ///< where the mean force points, at the scan's end; unit vector
  bool at_rest = false;          ///< the IMU feels nothing but gravity and its biases
};
/// Nothing where the IMU does not cover the scan.
std::optional<FirstScan> firstScan(ScanTimes scan, const ImuBuffer& imu,
                                   const FrontendSettings& settings, const LioState& x);

/// How well rest is known (standard deviations, m/s and m/s2), where the IMU tells of it.
inline constexpr double kRestSpeed = 0.1, kRestAcceleration = 0.03;
/// How wrong is what a scan tells that the IMU does not cover (standard deviations): as if half of
/// it were turned by half a radian a second. It is not to go into a map.
inline constexpr double kBlindPosition = 0.05, kBlindRotation = 0.025, kBlindVelocity = 0.5;

/// What the IMU says of the way to a scan and of the scan.
class ScanInertia {
 public:
  explicit ScanInertia(const FrontendSettings& settings) : settings_(settings) {}

  /// From `last_ns`, where the state was `x`, to the end of the scan. Where the IMU does not cover
  /// all of it, an even motion is assumed, with the noise of what a body may do.
  void follow(ScanTimes scan, const ImuBuffer& imu, TimeNs last_ns, const LioState& x);

  bool measured() const { return measured_; }
  const KeptScan& scan() const { return scan_; }
  const Preintegration& motion() const { return *motion_; }
  const ImuNoise& noise() const { return noise_; }
  int intervalsWithoutImu() const { return without_; }

 private:
  FrontendSettings settings_;
  bool measured_ = true;
  KeptScan scan_;
  std::optional<Preintegration> motion_;
  ImuNoise noise_;
  Vec3 last_rate_body_ = Vec3::Zero();  // as measured (rad/s), before a gap of the IMU
  int without_ = 0;
};

}  // namespace paloc
