#include "paloc/tools/synth_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "paloc/tools/synth_random.h"

namespace paloc::synth {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kControlInterval = 0.05;  // s: a ninth of a step's period
constexpr double kRestStart = 2.5, kRestEnd = 2.0, kPause = 3.0, kRamp = 1.2;  // s

/// From 0 to 1 with no jump in velocity and acceleration.
double smoothStep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 + x * (-15 + 6 * x));
}

/// The closed route as a smooth curve by arc length.
class Route {
 public:
  explicit Route(const std::vector<Vec3>& corners) {
    std::vector<Vec3> samples;
    double s = 0;  // along the leg, of the next sample
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3& from = corners[i];
      const Vec3 way = corners[(i + 1) % corners.size()] - from;
      for (; s < way.norm(); s += kStep) samples.push_back(from + way.normalized() * s);
      s -= way.norm();
    }
    for (std::size_t i = 0; i < samples.size(); ++i) points_.push_back(rounded(samples, i));
  }

  Vec3 at(double s) const {
    const double x = s / kStep, floor = std::floor(x);
    return points_[index(floor)] +
           (x - floor) * (points_[index(floor + 1)] - points_[index(floor)]);
  }
  Vec3 direction(double s) const { return (at(s + 0.2) - at(s - 0.2)).normalized(); }

 private:
  static constexpr double kStep = 0.02, kRounding = 0.28;  // m; standard deviation of a Gaussian

  std::size_t index(double i) const {
    const auto n = static_cast<double>(points_.size());
    return static_cast<std::size_t>(i - n * std::floor(i / n)) % points_.size();
  }

  static Vec3 rounded(const std::vector<Vec3>& samples, std::size_t at) {
    const auto n = static_cast<long>(samples.size());
    const long reach = std::lround(3 * kRounding / kStep);
    Vec3 sum = Vec3::Zero();
    double weights = 0;
    for (long k = -reach; k <= reach; ++k) {
      const double x = static_cast<double>(k) * kStep / kRounding;
      const double weight = std::exp(-x * x / 2);
      sum += weight * samples[static_cast<std::size_t>(((static_cast<long>(at) + k) % n + n) % n)];
      weights += weight;
    }
    return sum / weights;
  }

  std::vector<Vec3> points_;
};

/// How much of walking there is at time t: 0 at rest, 1 in full motion.
double activity(double t, double duration) {
  const auto ramp = [&](double from) { return smoothStep((t - from) / kRamp); };
  double value = ramp(kRestStart) * (1 - ramp(duration - kRestEnd - kRamp));
  const int pauses = std::max(1, static_cast<int>(std::lround(duration / 60)));
  if (duration < kRestStart + kRestEnd + kPause + 6 * kRamp) return value;
  for (int i = 0; i < pauses; ++i) {
    const double middle = (i + 0.5) * duration / pauses;
    value *= 1 - ramp(middle - kPause / 2 - kRamp) * (1 - ramp(middle + kPause / 2));
  }
  return value;
}

}  // namespace

Motion makeWalk(const std::vector<Vec3>& corners, double duration_s, TimeNs start_ns,
                std::uint64_t seed) {
  const Route route(corners);
  RandomStream random(seed, RandomPurpose::kWalk, 0);
  double phase[8];
  for (double& p : phase) p = kTwoPi * random.uniform();
  const auto wave = [&](double frequency, double t, int i) {
    return std::sin(kTwoPi * frequency * t + phase[i]);
  };
  std::vector<Pose> poses;
  double way = 0, step_phase = phase[0], yaw = 0;
  const int count = static_cast<int>(std::ceil(duration_s / kControlInterval)) + 1;
  for (int i = 0; i < count; ++i) {
    const double t = i * kControlInterval, active = activity(t, duration_s);
    const double speed = active * (1.05 + 0.16 * wave(0.11, t, 1) + 0.06 * wave(0.31, t, 2));
    way += speed * kControlInterval;
    // Two steps to a sway; steps come quicker when walking faster.
    step_phase += kTwoPi * 1.8 * (0.7 + 0.3 * speed / 1.05) * kControlInterval;

    const Vec3 ahead = route.direction(way);
    const double heading = std::atan2(ahead.y(), ahead.x());
    yaw = i == 0 ? heading : yaw + std::remainder(heading - yaw, kTwoPi);
    const double look = active * (0.22 * wave(0.13, t, 3) + 0.14 * wave(0.29, t, 4));
    const double pitch = active * (0.030 * std::sin(step_phase + 0.7) + 0.035 * wave(0.23, t, 5));
    const double roll =
        active * (0.026 * std::sin(step_phase / 2 + 0.3) + 0.025 * wave(0.37, t, 6));
    const double step_yaw = active * 0.02 * std::sin(step_phase / 2 + 1.1);

    const Vec3 left(-ahead.y(), ahead.x(), 0);
    const Vec3 gait =
        active * (0.015 * std::sin(step_phase / 2) * left +
                  (0.02 * std::sin(step_phase) + 0.03 * wave(0.17, t, 7)) * Vec3::UnitZ());
    poses.push_back({route.at(way) + gait + kCarryHeight_m * Vec3::UnitZ(),
                     so3::exp(Vec3(0, 0, yaw + look + step_yaw)) *
                         so3::exp(Vec3(0, pitch + 0.03, 0)) * so3::exp(Vec3(roll - 0.02, 0, 0))});
  }
  return Motion(poses, kControlInterval, start_ns);
}

}  // namespace paloc::synth
