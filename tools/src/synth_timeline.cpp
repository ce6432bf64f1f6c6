#include "paloc/tools/synth_timeline.h"

#include <cmath>
#include <cstdio>

#include "paloc/core/errors.h"

namespace paloc::synth {
namespace {

constexpr TimeNs kWalkStart = 1'700'000'000 * kNsPerSecond;
// The IMU starts before the scans and ends after them; a scan starts between two IMU samples, as
// scans do.
constexpr TimeNs kLead = 103'700'000, kTail = 100'000'000;  // ns

TimeNs upToTick(TimeNs t) { return (t + 99) / 100 * 100; }  // MRPT's clock ticks every 100 ns

std::string drivenNote(const DrivenMotion& driven) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the motion keeps to the given trajectory by %.1f mm (RMS; at worst %.1f mm), smoothed",
      1e3 * driven.deviation_rms_m, 1e3 * driven.deviation_max_m);
  return text;
}

}  // namespace

Timeline makeTimeline(const SynthSettings& settings, const std::vector<Vec3>& route,
                      const SensorModel& sensor) {
  const double period_s = secondsBetween(0, sensor.period_ns);
  const double margins_s = secondsBetween(0, kLead + kTail);
  auto scans = static_cast<std::size_t>(settings.duration_s / period_s + 1e-9);
  if (scans == 0) throw UsageError("--duration: shorter than one scan");
  std::vector<std::string> notes;
  Motion motion = [&] {
    if (settings.trajectory.empty()) {
      return makeWalk(route, settings.duration_s + margins_s, kWalkStart, settings.seed);
    }
    DrivenMotion driven = motionFromFile(settings.trajectory, settings.trajectory_smoothing_s);
    const double left = driven.motion.duration() - margins_s - period_s;
    if (left < period_s) throw IoError(settings.trajectory.string() + ": too short for one scan");
    scans = std::min(scans, static_cast<std::size_t>(left / period_s));
    notes.push_back(drivenNote(driven));
    if (driven.longest_gap_s > 1) {
      char text[120];
      std::snprintf(text, sizeof text,
                    "the given trajectory has gaps of up to %.1f s: straight on there",
                    driven.longest_gap_s);
      notes.emplace_back(text);
    }
    return std::move(driven.motion);
  }();
  Timeline timeline(std::move(motion));
  const TimeNs start = upToTick(timeline.motion.startNs());
  timeline.first_scan_ns = start + kLead;
  timeline.period_ns = sensor.period_ns;
  timeline.scans = scans;
  timeline.notes = std::move(notes);
  for (std::size_t i = 0; i < scans; ++i) {
    const TimeNs end = timeline.scanStart(i) + sensor.duration();
    timeline.truth.push_back({end, timeline.motion.at(end).T_map_body});
    if (i == 0) continue;
    timeline.length_m +=
        (timeline.truth[i].pose.position - timeline.truth[i - 1].pose.position).norm();
  }
  timeline.odometry = simulateOdometry(settings.odometry, timeline.truth, settings.seed);
  const TimeNs end = timeline.truth.back().t_ns + kTail;
  timeline.imu = simulateImu(settings.imu, timeline.motion, start, end, settings.seed);
  return timeline;
}

}  // namespace paloc::synth
