// An odometry of one's own, as a plugin: each scan is registered to the one before it.
//
//   cmake -S . -B build && cmake --build build
//   paloc replay LOG --map MAP --plugin build/libscan_to_scan.so --frontend scan_to_scan
//
// What is a front-end's work besides (which observations to take, their order, the IMU, deskewing)
// makeTrackedOdometry() does. To do that, too, in another way, derive from OdometryFrontend.
#include <memory>
#include <optional>

#include "paloc/frontends/frontend_plugin.h"
#include "paloc/frontends/icp_filter.h"
#include "paloc/frontends/point_selection.h"
#include "paloc/frontends/scan_tracker.h"

namespace {

using namespace paloc;

class ScanToScan : public ScanTracker {
 public:
  explicit ScanToScan(const FrontendSettings& settings)
      : map_(settings.local_map), selection_(settings) {}

  Outcome add(const LidarFrame& frame, const ImuBuffer& /*imu*/, bool has_times) override {
    const Vec3 sensor_body = frame.T_body_lidar.position;
    selection_.select(frame, has_times, kMapPoints, nullptr, map_points_);
    points_ = everyNth(map_points_, kMapPoints / 5);
    const bool first = !first_motion_;
    if (first) {
      ChordVector sigma = ChordVector::Zero();
      sigma.segment<3>(chord::kVelocity).setConstant(1);  // m/s
      sigma.segment<3>(chord::kRate).setConstant(0.5);    // rad/s
      filter_.begin({}, sigma.cwiseAbs2().asDiagonal());
    } else {
      filter_.predict(secondsBetween(end_ns_, frame.endNs()));
      matched_ = filter_.update(points_, sensor_body, map_);
    }
    start_ns_ = frame.stamp_ns;
    end_ns_ = frame.endNs();
    if (first) first_motion_ = scanMotion();
    map_.clear();  // of the last scan only: what an odometry with a map does better
    for (const PlacedPoint& p : filter_.place(map_points_, sensor_body)) {
      map_.add(p.point_odom, p.ray);
    }
    if (first) return Outcome::kBegun;
    return 2 * matched_ > points_.size() ? Outcome::kTracked : Outcome::kCoasted;
  }

  const Pose& odometryPose() const override { return filter_.state().T_odom_body; }
  Mat6 motionCovariance() const override { return filter_.motionCovariance(); }
  ScanMotion scanMotion() const override {
    ScanMotionInput input;
    input.start_ns = start_ns_;
    input.end_ns = end_ns_;
    input.odometry = {{start_ns_, filter_.state().before(secondsBetween(start_ns_, end_ns_))},
                      {end_ns_, filter_.state().T_odom_body}};
    return ScanMotion(input);
  }
  ScanMotion firstScanMotion() const override { return *first_motion_; }
  std::size_t mapBytes() const override { return map_.bytes(); }
  std::string whoseMotionWhereCoasted() const override { return "taken from the scan before"; }

 private:
  static constexpr std::size_t kMapPoints = 15000;

  IcpFilter filter_{{}, {}};
  LocalVoxelMap map_;
  PointSelection selection_;
  std::vector<MeasuredPoint> map_points_, points_;
  TimeNs start_ns_ = 0, end_ns_ = 0;  // of the last scan
  std::size_t matched_ = 0;
  std::optional<ScanMotion> first_motion_;
};

void registerScanToScan() {
  OdometryFrontend::registerFrontend("scan_to_scan", [](const FrontendSettings& settings) {
    return makeTrackedOdometry("scan_to_scan", std::make_unique<ScanToScan>(settings), settings);
  });
}

}  // namespace

PALOC_FRONTEND_PLUGIN(registerScanToScan)
