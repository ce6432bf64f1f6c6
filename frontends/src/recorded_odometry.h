#pragma once

#include <deque>

#include "paloc/frontends/deskew.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/odometry_frontend.h"
#include "paloc/frontends/odometry_track.h"
#include "sensor_intake.h"

namespace paloc {

/// The odometry that another system wrote, in the recording or in a TUM file beside it. A scan
/// waits until the IMU and the odometry reach its end, or until the recording is `max_wait_s` past
/// it.
///
/// A frame whose end the odometry does not reach comes without a pose: `T_odom_body` is the
/// identity, and neither it nor the next frame `continues`.
class RecordedOdometry : public OdometryFrontend {
 public:
  /// Throws IoError if the odometry file cannot be read.
  explicit RecordedOdometry(const FrontendSettings& settings);

  void add(const mrpt::obs::CObservation& observation) override;
  void finish() override;
  std::optional<FrontendEvent> next() override;
  const UnusedCounts& unused() const override { return intake_.unused(); }
  std::vector<std::string> takeNotes() override { return intake_.takeNotes(); }
  std::vector<std::string> problems() const override;

 private:
  struct FramePose {
    TimeNs t_ns = 0;
    OdometryTrack::Lookup odometry;
  };

  void readOdometryFile();
  void addOdometry(const mrpt::obs::CObservation& observation);

  bool reaches(TimeNs t_ns) const;
  void giveOutWhatIsReady();
  void giveOutImu(TimeNs until_ns);
  void giveOutFrame(const LidarFrame& frame);
  void placeInOdometry(OdometryFrame& result);
  Mat6 motionCovariance(const FramePose& from, const FramePose& to) const;

  std::shared_ptr<const Scan> scanOf(const LidarFrame& frame);
  ScanMotion motionDuring(const LidarFrame& frame);

  void noteAtEnd();
  void noteScans();

  FrontendSettings settings_;
  SensorIntake intake_;
  StreamChoice odometry_;
  StampOrder odometry_order_;
  OdometryTrack track_;
  std::optional<FramePose> last_pose_;
  std::optional<Vec3> last_v_body_;  // at the end of the last scan whose motion is known
  TimeNs last_v_ns_ = 0;

  std::deque<FrontendEvent> events_;
  struct {
    int frames = 0, with_scan = 0, without_pose = 0, extrapolated = 0, coasted = 0,
        by_odometry_alone = 0;
  } counts_;
};

}  // namespace paloc
