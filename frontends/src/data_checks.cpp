#include "paloc/frontends/data_checks.h"

#include <mrpt/obs/CObservationIMU.h>

#include <algorithm>
#include <deque>

#include "data_check.h"
#include "log_histogram.h"
#include "motion_check.h"
#include "motion_judges.h"
#include "paloc/core/text.h"
#include "paloc/frontends/imu_reader.h"
#include "paloc/frontends/lidar_decoder.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/frontends/tum_file.h"
#include "stream_choice.h"

namespace paloc {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservationIMU;

std::vector<DataCheckPtr> checksOf(const CheckedStream& stream, const FrontendSettings& settings) {
  std::vector<DataCheckPtr> checks;
  checks.push_back(makeStampCheck(stream));
  checks.push_back(makeRateCheck(stream, settings));
  checks.push_back(makeRefusedCheck(stream));
  if (stream.kind == StreamKind::kImu) {
    checks.push_back(makeAccelerationCheck(stream));
    checks.push_back(makeRepeatedCheck(stream));
    checks.push_back(makeSaturationCheck(stream));
  }
  if (stream.kind == StreamKind::kLidar) checks.push_back(makePointTimesCheck(stream));
  return checks;
}

/// A stream of the recording with its checks.
struct Stream {
  std::string class_name;
  CheckedStream stream;
  std::vector<DataCheckPtr> checks;
  std::uint64_t count = 0;

  template <typename Tell>
  void each(const Tell& tell) {
    for (const DataCheckPtr& check : checks) tell(*check);
  }
};

bool isOfPointTimes(const Finding& finding) {
  return finding.check == "point-times" && finding.severity == Severity::kError;
}

bool isTold(const Findings& findings, const Finding& finding) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& told) {
    return told.check == finding.check && told.label == finding.label;
  });
}

}  // namespace

struct DataChecks::Impl {
  Impl(const FrontendSettings& front_settings, Extent extent_of_checks)
      : settings(front_settings),
        extent(extent_of_checks),
        lidar("LiDAR", settings.lidar_label),
        imu("IMU", settings.imu_label),
        odometry("odometry", settings.odometry_label),
        motion(settings) {}

  void addOdometryFile();
  Stream& streamOf(StreamKind kind, const CObservation& observation);
  void addImu(const CObservationIMU& observation, TimeNs t_ns);
  void addOdometry(const CObservation& observation, TimeNs t_ns);
  void addLidar(const CObservation& observation, TimeNs t_ns);
  void addRanges(const LidarFrame& frame);
  void judgeMotions();

  FrontendSettings settings;
  Extent extent;
  StreamChoice lidar, imu, odometry;
  std::deque<Stream> streams;  // in the order of their first observation
  MotionCheck motion;
  std::vector<StampedPose> odometry_file;
  LogHistogram ranges;
  LidarFrame recycled;
  std::vector<MotionComparison> motions;
  Findings findings;
};

// At the end: the recording's first stamp, not the file's, tells which time is looked at.
void DataChecks::Impl::addOdometryFile() {
  for (const StampedPose& stamped : odometry_file) {
    motion.addOdometry(settings.odometry_file, {stamped.t_ns, stamped.pose, std::nullopt});
  }
}

Stream& DataChecks::Impl::streamOf(StreamKind kind, const CObservation& observation) {
  const std::string class_name = observation.GetRuntimeClass()->className;
  const auto found = std::find_if(streams.begin(), streams.end(), [&](const Stream& stream) {
    return stream.class_name == class_name && stream.stream.label == observation.sensorLabel;
  });
  if (found != streams.end()) return *found;
  const CheckedStream stream{kind, observation.sensorLabel};
  return streams.emplace_back(Stream{class_name, stream, checksOf(stream, settings), 0});
}

void DataChecks::Impl::addImu(const CObservationIMU& observation, TimeNs t_ns) {
  Stream& stream = streamOf(StreamKind::kImu, observation);
  stream.each([&](DataCheck& check) { check.addStamp(t_ns); });
  std::string refusal;
  const auto sample = decodeImu(observation, refusal);
  if (!sample) return stream.each([&](DataCheck& check) { check.addRefused(t_ns, refusal); });
  stream.each([&](DataCheck& check) { check.addImu(*sample); });
  if (imu.takes(stream.class_name, observation.sensorLabel)) {
    motion.addImu(observation.sensorLabel, *sample);
  }
}

void DataChecks::Impl::addOdometry(const CObservation& observation, TimeNs t_ns) {
  Stream& stream = streamOf(StreamKind::kOdometry, observation);
  stream.each([&](DataCheck& check) { check.addStamp(t_ns); });
  std::string refusal;
  const auto pose = decodeOdometry(observation, refusal);
  if (!pose) return stream.each([&](DataCheck& check) { check.addRefused(t_ns, refusal); });
  if (!settings.odometry_file.empty()) return;  // it is used instead
  if (odometry.takes(stream.class_name, observation.sensorLabel)) {
    motion.addOdometry(observation.sensorLabel, *pose);
  }
}

void DataChecks::Impl::addLidar(const CObservation& observation, TimeNs t_ns) {
  constexpr std::uint64_t kCheapFirst = 5, kCheapEvery = 50;
  Stream& stream = streamOf(StreamKind::kLidar, observation);
  stream.each([&](DataCheck& check) { check.addStamp(t_ns); });
  const std::uint64_t index = stream.count++;
  if (extent == Extent::kCheap && index >= kCheapFirst && index % kCheapEvery != 0) return;
  std::string refusal;
  auto frame = decodeLidar(observation, {}, refusal, std::move(recycled));
  recycled = {};
  if (!frame) return stream.each([&](DataCheck& check) { check.addRefused(t_ns, refusal); });
  stream.each([&](DataCheck& check) { check.addScan(*frame); });
  const bool chosen = lidar.takes(stream.class_name, observation.sensorLabel);
  if (chosen) addRanges(*frame);
  if (chosen && extent == Extent::kFull) motion.addScan(*frame);
  recycled = std::move(*frame);
}

void DataChecks::Impl::addRanges(const LidarFrame& frame) {
  constexpr std::size_t kStride = 97;  // some points tell it well enough
  for (std::size_t i = 0; i < frame.points_lidar.size(); i += kStride) {
    const Point3f& p = frame.points_lidar[i];
    ranges.add(Vec3(p.x, p.y, p.z).norm());
  }
}

// Scans whose point times are wrong move in a way that says nothing of the IMU.
void DataChecks::Impl::judgeMotions() {
  const bool times_wrong = std::any_of(findings.begin(), findings.end(), isOfPointTimes);
  motions = motion.compare();
  if (times_wrong) std::erase_if(motions, [](const auto& of) { return !of.of_odometry; });
  for (const MotionComparison& comparison : motions) {
    Findings judged;
    judgeAgreement(comparison, judged);
    judgeGyroUnit(comparison, judged);
    judgeExtrinsics(comparison, judged);
    judgeClockOffset(comparison, judged);
    // Of the IMU alone one sensor has told enough.
    for (Finding& finding : judged) {
      if (!isTold(findings, finding)) findings.push_back(std::move(finding));
    }
  }
}

DataChecks::DataChecks(const FrontendSettings& settings, Extent extent)
    : impl_(std::make_unique<Impl>(settings, extent)) {
  if (!settings.odometry_file.empty()) impl_->odometry_file = readTum(settings.odometry_file);
}
DataChecks::~DataChecks() = default;

void DataChecks::add(const CObservation& observation) {
  const TimeNs t_ns = fromMrptTime(observation.timestamp);
  if (const auto* imu = dynamic_cast<const CObservationIMU*>(&observation)) {
    impl_->addImu(*imu, t_ns);
  } else if (isOdometry(observation)) {
    impl_->addOdometry(observation, t_ns);
  } else if (isLidar(observation)) {
    impl_->addLidar(observation, t_ns);
  }
}

void DataChecks::finish() {
  for (Stream& stream : impl_->streams) {
    stream.each([&](const DataCheck& check) { check.report(impl_->findings); });
  }
  impl_->addOdometryFile();
  impl_->judgeMotions();
  std::stable_partition(impl_->findings.begin(), impl_->findings.end(),
                        [](const Finding& f) { return f.severity != Severity::kNote; });
}

const Findings& DataChecks::findings() const { return impl_->findings; }
const std::vector<MotionComparison>& DataChecks::motions() const { return impl_->motions; }

double DataChecks::scanReach() const { return impl_->ranges.quantile(0.9); }

}  // namespace paloc
