#include "fast_lio_odometry.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/deskew.h"

namespace paloc {
namespace {

constexpr double kNoteworthyNoise = 5;  // in that of the settings

std::string timesText(int count) {
  return std::to_string(count) + (count == 1 ? " time" : " times");
}

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
  intake_.unused().add(frame.class_name, frame.label, "points without a valid return",
                       frame.invalid_points);
  const LioTracker::Outcome outcome = tracker_.add(frame, imu_, pointsHaveTimes(frame));
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
      first_ = frame;
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
  if (!first_) result.scan = makeScan(frame, tracker_.scanMotion());
  events_.emplace_back(std::move(result));
}

// The event of the first frame lies among the others, without its scan.
void FastLioOdometry::releaseFirst() {
  if (!first_) return;
  const auto event = std::find_if(events_.begin(), events_.end(), [&](const FrontendEvent& e) {
    const auto* frame = std::get_if<OdometryFrame>(&e);
    return frame && frame->t_ns == first_->endNs();
  });
  const LidarFrame frame = *std::exchange(first_, std::nullopt);
  if (event == events_.end()) return;
  std::get<OdometryFrame>(*event).scan = makeScan(frame, tracker_.firstScanMotion());
}

bool FastLioOdometry::pointsHaveTimes(const LidarFrame& frame) {
  if (frame.deskewed || frame.duration_ns == 0) return false;
  if (!settings_.deskew) {
    intake_.note("scans are not deskewed, as the settings say");
    return false;
  }
  return !frame.dt_ns.empty();
}

std::shared_ptr<const Scan> FastLioOdometry::makeScan(const LidarFrame& frame,
                                                      const ScanMotion& motion) {
  StageScope stage(timer_, "deskew");
  if (frame.points_lidar.empty()) {
    intake_.unused().add(frame.class_name, frame.label, "scan without a point");
    return nullptr;
  }
  const RangeLimits limits{settings_.min_range_m, settings_.max_range_m};
  DroppedPoints dropped;
  std::shared_ptr<Scan> scan;
  if (pointsHaveTimes(frame)) {
    scan = std::make_shared<Scan>(deskew(frame, motion, limits, dropped));
  } else {
    if (!frame.deskewed && frame.dt_ns.empty()) {
      intake_.unused().add(frame.class_name, frame.label, "not deskewed: no time for each point");
    }
    scan = std::make_shared<Scan>(placeOnBody(frame, limits, dropped));
  }
  intake_.unused().add(frame.class_name, frame.label, "points nearer than min_range_m",
                       dropped.too_near);
  intake_.unused().add(frame.class_name, frame.label, "points beyond max_range_m", dropped.too_far);
  if (!scan->points_body.empty()) {
    ++counts_.with_scan;
    return scan;
  }
  intake_.unused().add(frame.class_name, frame.label, "scan without a point within range");
  return nullptr;
}

void FastLioOdometry::finish() {
  if (intake_.finished()) return;
  intake_.finish();
  giveOutWhatIsReady();
  releaseFirst();
  if (!intake_.imu().empty()) giveOutImu(intake_.imu().newestNs());
  intake_.noteAtEnd();
  noteAtEnd();
}

void FastLioOdometry::noteAtEnd() {
  if (counts_.begun > 1) {
    intake_.note("the odometry began anew " + timesText(counts_.begun - 1));
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
    char text[160];
    std::snprintf(
        text, sizeof text,
        "the IMU disagrees with the scans: its noise was taken as up to %.0f times that of "
        "the settings (imu.*_noise_density); look at its scale, filter and clock",
        tracker_.worstImuNoise());
    intake_.note(text);
  }
  if (counts_.without_imu > 0) {
    intake_.note(std::to_string(counts_.without_imu) + of_all +
                 "could not be used: fast_lio begins with a scan during which there is IMU data");
  }
}

std::optional<FrontendEvent> FastLioOdometry::next() {
  if (events_.empty()) return std::nullopt;
  const auto* frame = std::get_if<OdometryFrame>(&events_.front());
  if (first_ && frame && frame->t_ns == first_->endNs()) return std::nullopt;
  // Not a plain move of the variant: GCC 12 at -O3 then warns of an uninitialized member.
  auto event = std::visit([](auto& e) { return std::optional<FrontendEvent>(std::move(e)); },
                          events_.front());
  events_.pop_front();
  return event;
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
