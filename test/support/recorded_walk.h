#pragma once

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "box_world.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/odometry_frontend.h"

/// A recording of a walk through a room, and what a front-end makes of it.
namespace paloc::test::recorded {

using mrpt::obs::CObservation;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationRobotPose;

inline constexpr TimeNs kT0 = 5 * kNsPerSecond;  // the first scan's stamp
inline constexpr TimeNs kMs = 1'000'000;
inline constexpr TimeNs kScan = 100 * kMs;

inline CObservation::Ptr imuAt(TimeNs t_ns, const std::string& label = "imu") {
  const ImuSample sample = test::imuOnPath(test::sway(), t_ns);
  auto imu = CObservationIMU::Create();
  imu->timestamp = toMrptTime(t_ns);
  imu->sensorLabel = label;
  using namespace mrpt::obs;
  imu->set(IMU_X_ACC, sample.acc_body.x());
  imu->set(IMU_Y_ACC, sample.acc_body.y());
  imu->set(IMU_Z_ACC, sample.acc_body.z());
  imu->set(IMU_WX, sample.omega_body.x());
  imu->set(IMU_WY, sample.omega_body.y());
  imu->set(IMU_WZ, sample.omega_body.z());
  return imu;
}

inline Pose truth(TimeNs t_ns) { return test::sway()(static_cast<double>(t_ns) * 1e-9); }

inline std::shared_ptr<CObservationRobotPose> poseAt(TimeNs t_ns,
                                                     const std::string& label = "odom") {
  auto pose = CObservationRobotPose::Create();
  pose->timestamp = toMrptTime(t_ns);
  pose->sensorLabel = label;
  pose->pose.mean = toMrpt(truth(t_ns));
  return pose;
}

inline CObservation::Ptr scanAt(TimeNs t_ns, const std::string& label = "lidar") {
  auto scan = std::make_shared<obs::CObservationLidarScan>(
      test::scanRoom(test::BoxRoom{}, test::sway(), Pose{}, t_ns, kScan, 90, 4));
  scan->sensorLabel = label;
  return scan;
}

/// A recording, its observations in the order of their stamps.
class Recording {
 public:
  Recording& imu(TimeNs from, TimeNs to) {
    for (TimeNs t = from; t <= to; t += 5 * kMs) add(imuAt(t));
    return *this;
  }
  Recording& odometry(TimeNs from, TimeNs to, TimeNs step = 50 * kMs) {
    for (TimeNs t = from; t <= to; t += step) add(poseAt(t));
    return *this;
  }
  Recording& scans(int count) {
    for (int i = 0; i < count; ++i) add(scanAt(kT0 + i * kScan));
    return *this;
  }
  Recording& add(CObservation::Ptr observation) {
    observations_.push_back(std::move(observation));
    return *this;
  }
  std::vector<CObservation::Ptr> inOrder() const {
    auto sorted = observations_;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
    return sorted;
  }

 private:
  std::vector<CObservation::Ptr> observations_;
};

struct Output {
  std::vector<FrontendEvent> events;
  std::vector<OdometryFrame> frames;
  std::vector<ImuSample> imu;
  std::vector<std::string> notes, problems;
  std::vector<UnusedCounts::Row> unused;

  bool noted(const std::string& part) const { return anyHas(notes, part); }
  bool hasProblem(const std::string& part) const { return anyHas(problems, part); }
  static bool anyHas(const std::vector<std::string>& sentences, const std::string& part) {
    return std::any_of(sentences.begin(), sentences.end(), [&](const std::string& sentence) {
      return sentence.find(part) != std::string::npos;
    });
  }
  std::uint64_t count(const std::string& label, const std::string& reason) const {
    std::uint64_t sum = 0;
    for (const auto& row : unused)
      sum += row.label == label && row.reason == reason ? row.count : 0;
    return sum;
  }
};

inline Output run(const std::vector<CObservation::Ptr>& observations,
                  const FrontendSettings& settings = {}, const std::string& name = "recorded") {
  const auto frontend = OdometryFrontend::create(name, settings);
  Output output;
  const auto drain = [&] {
    while (auto event = frontend->next()) output.events.push_back(*event);
  };
  for (const auto& observation : observations) {
    frontend->add(*observation);
    drain();
  }
  frontend->finish();
  drain();
  for (const FrontendEvent& event : output.events) {
    if (const auto* frame = std::get_if<OdometryFrame>(&event)) output.frames.push_back(*frame);
    if (const auto* sample = std::get_if<ImuSample>(&event)) output.imu.push_back(*sample);
  }
  output.notes = frontend->takeNotes();
  output.problems = frontend->problems();
  output.unused = frontend->unused().rows();
  return output;
}

inline Recording walk(int scans) {
  const TimeNs end = kT0 + scans * kScan + 20 * kMs;
  return Recording().imu(kT0 - 22 * kMs, end).odometry(kT0 - 50 * kMs, end).scans(scans);
}

}  // namespace paloc::test::recorded
