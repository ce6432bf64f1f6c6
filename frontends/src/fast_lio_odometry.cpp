#include "fast_lio_odometry.h"

#include <algorithm>
#include <utility>

#include "event_queue.h"
#include "make_scan.h"
#include "paloc/core/mrpt_pose.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

constexpr double kNoteworthyNoise = 5;  // in that of the settings

}  // namespace

FastLioOdometry::FastLioOdometry(const FrontendSettings& settings)
    : settings_(settings), intake_(settings), tracker_(settings) {}

void FastLioOdometry::setStageTimer(StageTimer* timer) {
  timer_ = timer;
  tracker_.setStageTimer(timer);
}

void FastLioOdometry::add(const mrpt::obs::CObservation& observation) {
  {
    StageScope stage(timer_, "decode");
    if (!intake_.add(observation)) intake_.skip(observation, "not a LiDAR or IMU");
  }
  giveOutWhatIsReady();
}

void FastLioOdometry::giveOutWhatIsReady() {
  while (const LidarFrame* frame = intake_.readyScan()) {
    giveOutImu(frame->endNs());
    giveOutFrame(*frame);
    intake_.imu().forgetBefore(frame->stamp_ns);
    imu_.forgetBefore(frame->endNs());
    intake_.popScan();
  }
  if (const auto until_ns = intake_.imuReleaseNs()) giveOutImu(*until_ns);
}

void FastLioOdometry::giveOutImu(TimeNs until_ns) {
  while (auto sample = intake_.imu().takeUntil(until_ns)) {
    imu_.add(*sample);
    events_.emplace_back(*sample);
  }
}

void FastLioOdometry::giveOutFrame(const LidarFrame& frame) {
  OdometryFrame result;
  result.t_ns = frame.endNs();
  const bool deskew = !frame.points_lidar.empty() && intake_.canDeskew(frame);
  const LioTracker::Outcome outcome = tracker_.add(frame, imu_, deskew);
  releaseFirst();
  ++counts_.frames;
  switch (outcome) {
    case LioTracker::Outcome::kNoInertia:
      ++counts_.without_imu;
      intake_.unused().add(frame.class_name, frame.label, "scan not used: no IMU data during it");
      events_.emplace_back(std::move(result));
      return;
    case LioTracker::Outcome::kBegun:
      ++counts_.begun;
      first_ = {frame, deskew};
      break;
    case LioTracker::Outcome::kCoasted:
      ++counts_.coasted;
      intake_.unused().add(frame.class_name, frame.label,
                           "scan not registered: too few points on the local map");
      break;
    case LioTracker::Outcome::kTracked:
      break;
  }
  result.continues = outcome != LioTracker::Outcome::kBegun;
  if (result.continues) result.motion_covariance = tracker_.motionCovariance();
  result.T_odom_body = toMrpt(tracker_.state().T_odom_body);
  if (!first_) {
    const ScanMotion motion = tracker_.scanMotion();
    result.scan = scanOf(frame, deskew ? &motion : nullptr);
  }
  events_.emplace_back(std::move(result));
}

// The event of the first frame lies among the others, without its scan.
void FastLioOdometry::releaseFirst() {
  if (!first_) return;
  const auto event = std::find_if(events_.begin(), events_.end(), [&](const FrontendEvent& e) {
    const auto* frame = std::get_if<OdometryFrame>(&e);
    return frame && frame->t_ns == first_->frame.endNs();
  });
  const ScanMotion motion = tracker_.firstScanMotion();
  std::get<OdometryFrame>(*event).scan = scanOf(first_->frame, first_->deskew ? &motion : nullptr);
  first_.reset();
}

std::shared_ptr<const Scan> FastLioOdometry::scanOf(const LidarFrame& frame,
                                                    const ScanMotion* motion) {
  StageScope stage(timer_, "deskew");
  auto scan =
      makeScan(frame, motion, {settings_.min_range_m, settings_.max_range_m}, intake_.unused());
  counts_.with_scan += scan != nullptr;
  return scan;
}

void FastLioOdometry::finish() {
  if (intake_.finished()) return;
  intake_.finish();
  giveOutWhatIsReady();
  releaseFirst();
  if (!intake_.imu().empty()) giveOutImu(intake_.imu().newestNs());
  intake_.noteStreams();
  intake_.noteImuGaps();
  noteAtEnd();
}

void FastLioOdometry::noteAtEnd() {
  if (counts_.begun > 1) {
    intake_.note("the odometry began anew " + timesInFigures(counts_.begun - 1));
  }
  const std::string of_all = " of " + std::to_string(counts_.frames) + " scans ";
  if (counts_.coasted > 0) {
    intake_.note(std::to_string(counts_.coasted) + of_all +
                 "could not be registered to the local map: their motion is the IMU's");
  }
  if (tracker_.intervalsWithoutImu() > 0) {
    intake_.note("the IMU does not cover " + std::to_string(tracker_.intervalsWithoutImu()) +
                 of_all + "and the way to them: taken as an even motion");
  }
  if (tracker_.worstImuNoise() > kNoteworthyNoise) {
    intake_.note("the IMU disagrees with the scans: its noise was taken as up to " +
                 figure("%.0f", tracker_.worstImuNoise()) +
                 " times that of the settings (imu.*_noise_density); look at its scale, filter and "
                 "clock");
  }
  if (counts_.without_imu > 0) {
    intake_.note(std::to_string(counts_.without_imu) + of_all +
                 "could not be used: fast_lio begins with a scan during which there is IMU data");
  }
}

std::optional<FrontendEvent> FastLioOdometry::next() {
  if (events_.empty()) return std::nullopt;
  const auto* frame = std::get_if<OdometryFrame>(&events_.front());
  if (first_ && frame && frame->t_ns == first_->frame.endNs()) return std::nullopt;
  return takeFront(events_);
}

std::vector<std::string> FastLioOdometry::problems() const {
  std::vector<std::string> sentences = intake_.problems();
  if (counts_.frames > 0 && counts_.begun == 0) {
    sentences.push_back("fast_lio needs an IMU, and the recording has none during its scans");
  } else if (const auto sentence = intake_.whyNoScan(counts_.with_scan); !sentence.empty()) {
    sentences.push_back(sentence);
  }
  return sentences;
}

}  // namespace paloc
