#pragma once

#include <mrpt/obs/CObservationIMU.h>

#include <deque>
#include <set>

#include "imu_queue.h"
#include "paloc/frontends/deskew.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/lidar_decoder.h"
#include "paloc/frontends/odometry_frontend.h"
#include "paloc/frontends/odometry_track.h"
#include "stream_choice.h"

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
  const UnusedCounts& unused() const override { return unused_; }
  std::vector<std::string> takeNotes() override;
  std::vector<std::string> problems() const override;

 private:
  struct FramePose {
    TimeNs t_ns = 0;
    OdometryTrack::Lookup odometry;
  };

  void readOdometryFile();
  void addImu(const mrpt::obs::CObservationIMU& observation);
  void addOdometry(const mrpt::obs::CObservation& observation);
  void addLidar(const mrpt::obs::CObservation& observation);
  void skip(const mrpt::obs::CObservation& observation, const std::string& reason);

  bool isReady(const LidarFrame& frame) const;
  void giveOutWhatIsReady();
  void giveOutImu(TimeNs until_ns);
  void giveOutFrame(LidarFrame& frame);
  void placeInOdometry(OdometryFrame& result);
  Mat6 motionCovariance(const FramePose& from, const FramePose& to) const;

  std::shared_ptr<const Scan> makeScan(const LidarFrame& frame);
  bool canDeskew(const LidarFrame& frame);
  ScanMotion motionDuring(const LidarFrame& frame);
  void countDropped(const LidarFrame& frame, const DroppedPoints& dropped);

  void note(const std::string& sentence);
  void noteAtEnd();
  std::string whyNoScan() const;

  FrontendSettings settings_;
  StreamChoice lidar_, imu_, odometry_;
  StampOrder lidar_order_, imu_order_, odometry_order_;
  ImuQueue imu_samples_;
  OdometryTrack track_;
  std::deque<LidarFrame> waiting_;
  LidarFrame recycled_;  // its memory serves the next scan
  std::optional<FramePose> last_pose_;
  std::optional<TimeNs> last_end_ns_;  // of the last scan taken
  std::optional<TimeNs> newest_ns_;    // of all streams
  std::optional<Vec3> last_v_body_;    // at the end of the last scan whose motion is known
  TimeNs last_v_ns_ = 0;
  bool finished_ = false;

  std::deque<FrontendEvent> events_;
  UnusedCounts unused_;
  std::vector<std::string> notes_;
  std::set<std::string> said_;
  struct {
    int frames = 0, with_scan = 0, without_pose = 0, extrapolated = 0, coasted = 0,
        by_odometry_alone = 0;
  } counts_;
};

}  // namespace paloc
