#include "tracked_odometry.h"

#include <algorithm>
#include <utility>

#include "event_queue.h"
#include "make_scan.h"
#include "paloc/core/mrpt_pose.h"
#include "sentence_parts.h"

namespace paloc {

ScanTracker::~ScanTracker() = default;

OdometryFrontend::Ptr makeTrackedOdometry(std::string name, std::unique_ptr<ScanTracker> tracker,
                                          const FrontendSettings& settings) {
  return std::make_unique<TrackedOdometry>(std::move(name), std::move(tracker), settings);
}

TrackedOdometry::TrackedOdometry(std::string name, std::unique_ptr<ScanTracker> tracker,
                                 const FrontendSettings& settings)
    : name_(std::move(name)),
      settings_(settings),
      intake_(settings, tracker->columns()),
      tracker_(std::move(tracker)) {}

void TrackedOdometry::setStageTimer(StageTimer* timer) {
  timer_ = timer;
  tracker_->setStageTimer(timer);
}

void TrackedOdometry::add(const mrpt::obs::CObservation& observation) {
  {
    StageScope stage(timer_, "decode");
    if (!intake_.add(observation)) intake_.skip(observation, "not a LiDAR or IMU");
  }
  giveOutWhatIsReady();
}

void TrackedOdometry::giveOutWhatIsReady() {
  const auto imu_reaches = [this](TimeNs end_ns) {
    return intake_.imu().newestNs() >= end_ns + tracker_->imuLateNs();
  };
  while (LidarFrame* frame = intake_.readyScan(imu_reaches)) {
    const TimeNs late_ns = tracker_->imuLateNs();
    giveOutImu(frame->endNs() + late_ns);
    giveOutFrame(*frame);
    intake_.imu().forgetBefore(frame->stamp_ns);
    imu_.forgetBefore(frame->endNs() + std::min(late_ns, tracker_->imuLateNs()));
    intake_.popScan();
  }
  if (const auto until_ns = intake_.imuReleaseNs()) giveOutImu(*until_ns);
}

void TrackedOdometry::giveOutImu(TimeNs until_ns) {
  imu_clock_.reach(until_ns, tracker_->imuLateNs());
  while (auto sample = intake_.imu().takeUntil(until_ns)) {
    imu_.add(*sample);
    sample->t_ns = imu_clock_.toLidar(sample->t_ns);
    events_.emplace_back(*sample);
  }
}

// A scan that is not deskewed is registered where it was at half its time, more or less: the motion
// of its other half is taken to be as before, and may be none at all. Where an IMU told part of it,
// the pose is somewhere between.
Mat6 TrackedOdometry::addOtherHalf(const Pose& motion, Pose& T_odom_body) const {
  Vec6 whole;
  whole << motion.rotation.transpose() * motion.position, so3::log(motion.rotation);
  if (!tracker_->usesImu()) {
    T_odom_body = T_odom_body * Pose{0.5 * whole.head<3>(), so3::exp(0.5 * whole.tail<3>())};
  }
  whole.head<3>() = motion.position;
  return 0.25 * (whole * whole.transpose());
}

void TrackedOdometry::giveOutFrame(LidarFrame& frame) {
  OdometryFrame result;
  result.t_ns = frame.endNs();
  const bool deskew = !frame.points_lidar.empty() && intake_.canDeskew(frame);
  const ScanTracker::Outcome outcome = tracker_->add(frame, imu_, deskew);
  releaseFirst();
  ++counts_.frames;
  switch (outcome) {
    case ScanTracker::Outcome::kRefused:
      ++counts_.refused;
      intake_.unused().add(frame.class_name, frame.label,
                           "scan not used: " + tracker_->whyRefused());
      events_.emplace_back(std::move(result));
      return;
    case ScanTracker::Outcome::kBegun:
      ++counts_.begun;
      first_ = {frame, deskew};
      break;
    case ScanTracker::Outcome::kCoasted:
      ++counts_.coasted;
      intake_.unused().add(frame.class_name, frame.label, "scan not registered to the local map");
      break;
    case ScanTracker::Outcome::kTracked:
      break;
  }
  frame.T_body_lidar = tracker_->mountOf(frame.T_body_lidar);
  Pose T_odom_body = tracker_->odometryPose();
  const Pose motion_since_last = T_odom_body_last_.inverse() * T_odom_body;
  T_odom_body_last_ = T_odom_body;
  if (!first_) {
    const ScanMotion motion = withImu(frame, tracker_->scanMotion());
    result.continues = true;
    result.motion_covariance = tracker_->motionCovariance();
    if (!deskew && isSkewed(frame)) {
      result.motion_covariance += addOtherHalf(motion_since_last, T_odom_body);
    }
    // Without an IMU in the estimator the tracker's guess, with its covariance, is all there is.
    if (tracker_->usesImu() || motion.byImu()) result.open_motion = tracker_->openMotion();
    result.scan = scanOf(frame, deskew ? &motion : nullptr);
  }
  result.T_odom_body = toMrpt(T_odom_body);
  events_.emplace_back(std::move(result));
}

// How the body turned and sped up during a scan an IMU tells better than the scan itself, where the
// tracker knows of none.
ScanMotion TrackedOdometry::withImu(const LidarFrame& frame, const ScanMotion& by_tracker) const {
  if (tracker_->usesImu()) return by_tracker;
  ScanMotionInput input;
  input.start_ns = frame.stamp_ns;
  input.end_ns = frame.endNs();
  input.imu = intake_.imu().covering(input.start_ns, input.end_ns);
  input.up_body_end = intake_.imu().upAt(input.end_ns);
  if (input.imu.empty() || !input.up_body_end) return by_tracker;
  input.odometry = {{input.start_ns, by_tracker.bodyAt(input.start_ns)}, {input.end_ns, Pose{}}};
  return ScanMotion(input);
}

// The event of the first frame lies among the others, without its scan.
void TrackedOdometry::releaseFirst() {
  if (!first_) return;
  const auto event = std::find_if(events_.begin(), events_.end(), [&](const FrontendEvent& e) {
    const auto* frame = std::get_if<OdometryFrame>(&e);
    return frame && frame->t_ns == first_->frame.endNs();
  });
  const ScanMotion motion = tracker_->firstScanMotion();
  first_->frame.T_body_lidar = tracker_->mountOf(first_->frame.T_body_lidar);
  std::get<OdometryFrame>(*event).scan = scanOf(first_->frame, first_->deskew ? &motion : nullptr);
  first_.reset();
}

std::shared_ptr<const Scan> TrackedOdometry::scanOf(const LidarFrame& frame,
                                                    const ScanMotion* motion) {
  StageScope stage(timer_, "deskew");
  auto scan =
      makeScan(frame, motion, {settings_.min_range_m, settings_.max_range_m}, intake_.unused());
  counts_.with_scan += scan != nullptr;
  return scan;
}

void TrackedOdometry::finish() {
  if (intake_.finished()) return;
  intake_.finish();
  giveOutWhatIsReady();
  releaseFirst();
  if (!intake_.imu().empty()) giveOutImu(intake_.imu().newestNs());
  intake_.noteStreams();
  intake_.noteImuGaps();
  noteAtEnd();
}

void TrackedOdometry::noteAtEnd() {
  if (counts_.begun > 1) {
    intake_.note("the odometry began anew " + timesInFigures(counts_.begun - 1));
  }
  const std::string of_all = " of " + std::to_string(counts_.frames) + " scans ";
  if (counts_.coasted > 0) {
    intake_.note(std::to_string(counts_.coasted) + of_all +
                 "could not be registered to the local map: their motion is " +
                 tracker_->whoseMotionWhereCoasted());
  }
  if (counts_.refused > 0) {
    intake_.note(std::to_string(counts_.refused) + of_all + "could not be used: " + name_ + " " +
                 tracker_->need());
  }
  for (const std::string& sentence : tracker_->notes(counts_.frames)) intake_.note(sentence);
}

std::optional<FrontendEvent> TrackedOdometry::next() {
  if (events_.empty()) return std::nullopt;
  const auto* frame = std::get_if<OdometryFrame>(&events_.front());
  if (first_ && frame && frame->t_ns == first_->frame.endNs()) return std::nullopt;
  return takeFront(events_);
}

std::vector<std::string> TrackedOdometry::problems() const {
  std::vector<std::string> sentences = intake_.problems();
  if (counts_.frames > 0 && counts_.begun == 0) {
    sentences.push_back(name_ + " " + tracker_->need() + ": no scan of the recording has that");
  } else if (const auto sentence = intake_.whyNoScan(counts_.with_scan); !sentence.empty()) {
    sentences.push_back(sentence);
  }
  return sentences;
}

}  // namespace paloc
