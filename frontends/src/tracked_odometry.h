#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "paloc/frontends/imu_clock.h"
#include "paloc/frontends/odometry_frontend.h"
#include "paloc/frontends/scan_tracker.h"
#include "sensor_intake.h"

namespace paloc {

/// A front-end that finds the motion itself, by a ScanTracker.
///
/// The odom frame is the body at the end of the first scan; after a pause of more than `max_gap_s`,
/// or where the tracker lost itself, the odometry goes on from its last pose with a new map, and
/// the first frame does not `continue`. A scan that cannot be registered comes with the pose
/// predicted and the covariance of the prediction. The first frame is given out with the second,
/// which tells how the body moved during it. All that is given out has the LiDAR's clock, where the
/// tracker knows of an offset.
class TrackedOdometry : public OdometryFrontend {
 public:
  TrackedOdometry(std::string name, std::unique_ptr<ScanTracker> tracker,
                  const FrontendSettings& settings);

  void add(const mrpt::obs::CObservation& observation) override;
  void finish() override;
  std::optional<FrontendEvent> next() override;
  const UnusedCounts& unused() const override { return intake_.unused(); }
  std::vector<std::string> takeNotes() override { return intake_.takeNotes(); }
  std::vector<std::string> problems() const override;
  void setStageTimer(StageTimer* timer) override;
  std::size_t mapBytes() const override { return tracker_->mapBytes(); }

 private:
  void giveOutWhatIsReady();
  void giveOutImu(TimeNs until_ns);
  void giveOutFrame(LidarFrame& frame);
  void releaseFirst();
  Mat6 addOtherHalf(const Pose& motion, Pose& T_odom_body) const;
  ScanMotion withImu(const LidarFrame& frame, const ScanMotion& by_tracker) const;
  std::shared_ptr<const Scan> scanOf(const LidarFrame& frame, const ScanMotion* motion);
  void noteAtEnd();

  std::string name_;
  FrontendSettings settings_;
  SensorIntake intake_;
  ImuBuffer imu_;  // by its own clock
  ImuClock imu_clock_;
  std::unique_ptr<ScanTracker> tracker_;
  StageTimer* timer_ = nullptr;
  std::deque<FrontendEvent> events_;
  struct WaitingFrame {
    LidarFrame frame;
    bool deskew = false;
  };
  Pose T_odom_body_last_;
  std::optional<WaitingFrame> first_;  // of a stretch: its event waits for the next frame
  struct {
    int frames = 0, with_scan = 0, begun = 0, coasted = 0, refused = 0;
  } counts_;
};

}  // namespace paloc
