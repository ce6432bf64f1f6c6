#include "paloc/frontends/gravity_tracker.h"

#include <algorithm>

#include "paloc/core/so3.h"

namespace paloc {
namespace {

// Walking shakes at 2 Hz and more: over three seconds it averages out, while a gyroscope off by
// half a degree per second has turned up by no more than 0.03 rad.
constexpr double kTimeConstant = 3.0;  // s
constexpr double kLongestStep = 0.5;   // s; a longer gap starts anew

}  // namespace

void GravityTracker::add(const ImuSample& sample) {
  const double force = sample.acc_body.norm();
  if (!(force > 0)) return;
  const Vec3 measured = sample.acc_body / force;
  const double dt_s = up_ ? secondsBetween(last_.t_ns, sample.t_ns) : 0;
  if (!up_ || dt_s > kLongestStep) {
    up_ = measured;
    age_s_ = 0;
  } else {
    const Vec3 omega = 0.5 * (last_.omega_body + sample.omega_body);
    const Vec3 turned = so3::exp(-omega * dt_s) * *up_;
    age_s_ += dt_s;
    // At first the plain mean of what was seen so far.
    const double gain = std::min(1.0, dt_s / std::min(age_s_ + dt_s, kTimeConstant));
    up_ = (turned + gain * (measured - turned)).normalized();
  }
  last_ = sample;
}

}  // namespace paloc
