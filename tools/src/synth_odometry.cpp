#include "paloc/tools/synth_odometry.h"

#include <numbers>

#include "paloc/tools/synth_random.h"

namespace paloc::synth {
namespace {

constexpr double kReferenceWay = 10.0;  // m, over which the drift is stated

}  // namespace

std::vector<StampedPose> simulateOdometry(const OdometryModel& model,
                                          const std::vector<StampedPose>& truth,
                                          std::uint64_t seed) {
  RandomStream random(seed, RandomPurpose::kOdometry, 0);
  // A yaw drift of k rad/m leads k L^2 / 2 aside after L metres.
  const double part = model.drift / std::numbers::sqrt2;
  const double scale = model.scale * (1 + random.sign() * part);
  const double yaw_per_m = random.sign() * 2 * part / kReferenceWay;
  std::vector<StampedPose> odometry;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i == 0) {
      odometry.push_back({truth[0].t_ns, Pose{}});
      continue;
    }
    Pose step = truth[i - 1].pose.inverse() * truth[i].pose;
    const double way = step.position.norm();
    Vec3 position_noise, rotation_noise;
    for (int d = 0; d < 3; ++d) position_noise[d] = model.step_noise_m * random.normal();
    for (int d = 0; d < 3; ++d) rotation_noise[d] = model.step_noise_rad * random.normal();
    step.position = scale * step.position + position_noise;
    step.rotation = step.rotation * so3::exp(rotation_noise + Vec3(0, 0, yaw_per_m * way));
    Pose pose = odometry.back().pose * step;
    pose.rotation = so3::normalized(pose.rotation);
    odometry.push_back({truth[i].t_ns, pose});
  }
  return odometry;
}

}  // namespace paloc::synth
