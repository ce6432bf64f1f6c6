#pragma once

#include <mrpt/obs/CObservationIMU.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "imu_queue.h"
#include "paloc/core/unused_counts.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/lidar_decoder.h"
#include "paloc/frontends/lidar_frame.h"
#include "stream_choice.h"

namespace paloc {

/// The class of an observation, without its namespace.
std::string classNameOf(const mrpt::obs::CObservation& observation);

/// The LiDAR scans and IMU samples of a recording as a front-end takes them: of one stream each, in
/// the order of their stamps; what is not taken is counted with its reason. Scans wait until the
/// IMU reaches their end, or until the recording is `max_wait_s` past it.
class SensorIntake {
 public:
  /// `columns`: of the scans, besides points and times.
  explicit SensorIntake(const FrontendSettings& settings, LidarColumns columns = {});

  /// Takes a scan or an IMU sample; false if it is neither.
  bool add(const mrpt::obs::CObservation& observation);
  void finish() { finished_ = true; }
  bool finished() const { return finished_; }

  /// The oldest scan that waits, if it waits no longer; null if there is none. Valid until
  /// popScan(). `also_reaches` tells whether what else the scan waits for has come to its end.
  LidarFrame* readyScan(const std::function<bool(TimeNs)>& also_reaches);
  void popScan();

  /// The recording has come to a time, by another stream.
  void reached(TimeNs t_ns) { newest_ns_ = std::max(newest_ns_.value_or(t_ns), t_ns); }

  ImuQueue& imu() { return imu_samples_; }
  const ImuQueue& imu() const { return imu_samples_; }
  bool hasLidar() const { return lidar_.chosen(); }

  /// Whether a scan is to be deskewed; counts or notes why it cannot be, though it should.
  bool canDeskew(const LidarFrame& frame);

  /// Until when samples may be given out, where no scan waits: none is held longer than a scan
  /// could be late.
  std::optional<TimeNs> imuReleaseNs() const;

  void skip(const mrpt::obs::CObservation& observation, const std::string& reason);
  UnusedCounts& unused() { return unused_; }
  const UnusedCounts& unused() const { return unused_; }

  /// Keeps a sentence for the user, said once.
  void note(const std::string& sentence);
  std::vector<std::string> takeNotes();
  // What is known at the end: of several streams of a kind, of pauses.
  void noteStreams();
  void noteImuGaps();
  std::vector<std::string> problems() const;
  /// Why there is no scan, where `used` is 0; else empty.
  std::string whyNoScan(int used) const;

 private:
  void addImu(const mrpt::obs::CObservationIMU& observation);
  void addLidar(const mrpt::obs::CObservation& observation);

  FrontendSettings settings_;
  LidarColumns columns_;
  StreamChoice lidar_, imu_;
  StampOrder lidar_order_, imu_order_;
  ImuQueue imu_samples_;
  std::deque<LidarFrame> waiting_;
  LidarFrame recycled_;                // its memory serves the next scan
  std::optional<TimeNs> last_end_ns_;  // of the last scan taken
  std::optional<TimeNs> newest_ns_;    // of both streams
  bool finished_ = false;
  UnusedCounts unused_;
  std::vector<std::string> notes_;
  std::set<std::string> said_;
};

}  // namespace paloc
