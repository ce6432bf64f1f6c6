#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "paloc/core/imu_buffer.h"
#include "paloc/core/stage_timer.h"
#include "paloc/frontends/lidar_decoder.h"
#include "paloc/frontends/lidar_frame.h"
#include "paloc/frontends/odometry_frontend.h"
#include "paloc/frontends/scan_motion.h"

namespace paloc {

/// An odometry scan by scan: how the body moved, from the scans and perhaps the IMU, in an odom
/// frame that it chooses. What a front-end must do besides, makeTrackedOdometry() adds.
class PALOC_EXPORT ScanTracker {
 public:
  enum class Outcome {
    kTracked,
    kCoasted,  ///< the scan could not be registered: the pose is predicted
    kBegun,    ///< the first scan of a stretch: the motion since the last frame is not known
    kRefused,  ///< not begun: see whyRefused()
  };

  virtual ~ScanTracker();

  /// `imu` holds the samples since the last scan, those before and behind the scan's ends among
  /// them, where there are any. `has_times`: the points' times are to be used. The scan is later
  /// than all before.
  virtual Outcome add(const LidarFrame& frame, const ImuBuffer& imu, bool has_times) = 0;

  /// T_odom_body at the end of the scan that was added last.
  virtual const Pose& odometryPose() const = 0;
  /// Of the motion since the last frame (see OdometryFrame).
  virtual Mat6 motionCovariance() const = 0;
  /// What of that motion only the prediction told (see OdometryFrame::open_motion).
  virtual Mat6 openMotion() const { return Mat6::Zero(); }
  /// How the body moved during the scan that was added last, in poses of the odom frame.
  virtual ScanMotion scanMotion() const = 0;
  /// The same of the first scan of a stretch, once the second was added.
  virtual ScanMotion firstScanMotion() const = 0;
  /// Whether scanMotion() is by the IMU's samples; else those may tell it better.
  virtual bool usesImu() const { return true; }
  virtual std::size_t mapBytes() const = 0;
  /// By how much the IMU's stamps are later than the LiDAR's, for the scan to come. A tracker that
  /// says other than 0 is given both as they are, and takes account of it.
  virtual TimeNs imuLateNs() const { return 0; }
  /// Where the LiDAR sits, of what the recording says: as the scan that was added last tells it.
  virtual Pose mountOf(const Pose& T_body_lidar) const { return T_body_lidar; }
  /// Which columns of the scans it wants, besides points and times.
  virtual LidarColumns columns() const { return {}; }

  /// Sentences for the user, parts of them: "no IMU data during it"; "the IMU's".
  virtual std::string whyRefused() const { return {}; }
  virtual std::string whoseMotionWhereCoasted() const = 0;
  /// What the odometry needs, as the end of "NAME ".
  virtual std::string need() const { return "needs a scan with points"; }
  /// What is known at the end, after that many scans.
  virtual std::vector<std::string> notes(int /*scans*/) const { return {}; }

  void setStageTimer(StageTimer* timer) { timer_ = timer; }

 protected:
  StageTimer* timer_ = nullptr;
};

/// The front-end `name` that finds its motion by a tracker: it takes scans and IMU samples out of
/// the recording, brings them into order, gives the tracker each scan, and gives out its poses with
/// the scans deskewed to their ends.
PALOC_EXPORT OdometryFrontend::Ptr makeTrackedOdometry(std::string name,
                                                       std::unique_ptr<ScanTracker> tracker,
                                                       const FrontendSettings& settings);

}  // namespace paloc
