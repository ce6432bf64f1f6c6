#include "paloc/tools/synth_motion.h"

#include <algorithm>
#include <cmath>

namespace paloc::synth {
namespace {

constexpr int kDegree = 5;

// Coefficients of u^0 .. u^5 of the six basis functions of a uniform B-spline of degree five, times
// 120.
constexpr double kBasis[kDegree + 1][kDegree + 1] = {
    {1, -5, 10, -10, 5, -1},    {26, -50, 20, 20, -20, 5}, {66, 0, -60, 0, 30, -10},
    {26, 50, 20, -20, -20, 10}, {1, 5, 10, 10, 5, -5},     {0, 0, 0, 0, 0, 1},
};

// How often the end poses are repeated: so often that the spline comes to rest there.
constexpr int kHeld = 5;

}  // namespace

Motion::Motion(const std::vector<Pose>& poses, double dt_s, TimeNs start_ns)
    : dt_s_(dt_s), duration_s_(dt_s * static_cast<double>(poses.size() - 1)), start_ns_(start_ns) {
  controls_.reserve(poses.size() + 2UL * kHeld);
  Eigen::Vector4d last(0, 0, 0, 1);
  for (const Pose& pose : poses) {
    Eigen::Vector4d q = Quat(pose.rotation).coeffs();  // x y z w
    if (q.dot(last) < 0) q = -q;                       // of two signs the one that continues
    last = q;
    const Vec3& p = pose.position;
    controls_.push_back({p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]});
  }
  controls_.insert(controls_.begin(), kHeld, Control(controls_.front()));
  controls_.insert(controls_.end(), kHeld, Control(controls_.back()));
}

MotionState Motion::at(TimeNs t_ns) const {
  // A span begins where the weight of the third of its six control points is greatest.
  const double last_span = static_cast<double>(controls_.size()) - (kDegree + 1);
  const double x =
      std::clamp(secondsBetween(start_ns_, t_ns) / dt_s_ + (kHeld - 2), 0.0, last_span + 1);
  const double span = std::min(std::floor(x), last_span);
  const double u = x - span;
  const double h = 1 / dt_s_;
  Eigen::Matrix<double, 7, 3> value = Eigen::Matrix<double, 7, 3>::Zero();
  for (int i = 0; i <= kDegree; ++i) {
    double b = 0, db = 0, ddb = 0;  // Horner, with the derivatives
    for (int k = kDegree; k >= 0; --k) {
      ddb = ddb * u + 2 * db;
      db = db * u + b;
      b = b * u + kBasis[i][k] / 120;
    }
    const Control& c = controls_[static_cast<std::size_t>(span) + static_cast<std::size_t>(i)];
    for (int d = 0; d < 7; ++d) {
      const double weight = c[static_cast<std::size_t>(d)];
      value(d, 0) += b * weight;
      value(d, 1) += db * h * weight;
      value(d, 2) += ddb * h * h * weight;
    }
  }
  MotionState state;
  const Eigen::Quaterniond q(value(6, 0), value(3, 0), value(4, 0), value(5, 0));
  const Eigen::Quaterniond dq(value(6, 1), value(3, 1), value(4, 1), value(5, 1));
  state.T_map_body = {value.block<3, 1>(0, 0), q.normalized().toRotationMatrix()};
  state.v_map = value.block<3, 1>(0, 1);
  state.a_map = value.block<3, 1>(0, 2);
  state.omega_body = 2 * (q.conjugate() * dq).vec() / q.squaredNorm();
  return state;
}

}  // namespace paloc::synth
