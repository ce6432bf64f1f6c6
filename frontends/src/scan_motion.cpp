#include "paloc/frontends/scan_motion.h"

#include <algorithm>

#include "paloc/core/so3.h"

namespace paloc {
namespace {

// Local gravity differs from it by less than 0.03 m/s2: 0.04 mm in a scan of 0.1 s.
constexpr double kGravity = 9.81;  // m/s2

ImuSample interpolate(const ImuSample& a, const ImuSample& b, TimeNs t_ns) {
  if (b.t_ns == a.t_ns) return a;
  const double ratio = secondsBetween(a.t_ns, t_ns) / secondsBetween(a.t_ns, b.t_ns);
  return {t_ns, a.acc_body + ratio * (b.acc_body - a.acc_body),
          a.omega_body + ratio * (b.omega_body - a.omega_body)};
}

// The samples of the scan, with one made at each border.
std::vector<ImuSample> cutToScan(const std::vector<ImuSample>& imu, TimeNs start_ns,
                                 TimeNs end_ns) {
  std::vector<ImuSample> cut;
  for (std::size_t i = 0; i < imu.size(); ++i) {
    const bool starts = i + 1 < imu.size() && imu[i].t_ns <= start_ns && imu[i + 1].t_ns > start_ns;
    const bool ends = i > 0 && imu[i - 1].t_ns < end_ns && imu[i].t_ns >= end_ns;
    if (starts) cut.push_back(interpolate(imu[i], imu[i + 1], start_ns));
    if (imu[i].t_ns > start_ns && imu[i].t_ns < end_ns) cut.push_back(imu[i]);
    if (ends) cut.push_back(interpolate(imu[i - 1], imu[i], end_ns));
  }
  return cut;
}

}  // namespace

ScanMotion::ScanMotion(const ScanMotionInput& input)
    : start_ns_(input.start_ns), end_ns_(input.end_ns) {
  if (end_ns_ > start_ns_) {
    if (input.imu.size() >= 2 && input.up_body_end) {
      integrateImu(input);
      by_imu_ = true;
    } else if (input.odometry.size() >= 2) {
      followOdometry(input);
    } else if (input.v_body_start) {
      Knot start, end;
      end.t_s = secondsBetween(start_ns_, end_ns_);
      knots_ = {start, end};
      addVelocity(*input.v_body_start);
    }
  }
  if (knots_.empty()) knots_.push_back({});
  T_end_start_ = Pose{knots_.back().p, knots_.back().R}.inverse();
}

void ScanMotion::integrateImu(const ScanMotionInput& input) {
  const std::vector<ImuSample> imu = cutToScan(input.imu, start_ns_, end_ns_);
  for (const ImuSample& sample : imu) {
    Knot knot;
    knot.t_s = secondsBetween(start_ns_, sample.t_ns);
    knot.omega = sample.omega_body;
    if (!knots_.empty()) {
      const Knot& last = knots_.back();
      knot.R = last.R * so3::exp(0.5 * (last.omega + knot.omega) * (knot.t_s - last.t_s));
    }
    knots_.push_back(knot);
  }
  if (knots_.empty() || (input.odometry.size() < 2 && !input.v_body_start)) return;
  const Vec3 gravity_start = -kGravity * (knots_.back().R * *input.up_body_end);
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    knots_[i].a = knots_[i].R * imu[i].acc_body + gravity_start;
    if (i == 0) continue;
    const Knot& last = knots_[i - 1];
    const double dt = knots_[i].t_s - last.t_s;
    knots_[i].v = last.v + 0.5 * dt * (last.a + knots_[i].a);
    knots_[i].p = last.p + dt * last.v + dt * dt / 6 * (2 * last.a + knots_[i].a);
  }
  if (input.odometry.size() >= 2) {
    const Pose T_start_end = input.odometry.front().pose.inverse() * input.odometry.back().pose;
    addVelocity((T_start_end.position - knots_.back().p) / knots_.back().t_s);
  } else {
    addVelocity(*input.v_body_start);
  }
}

void ScanMotion::followOdometry(const ScanMotionInput& input) {
  even_steps_ = true;
  const Pose T_start_odom = input.odometry.front().pose.inverse();
  for (const StampedPose& stamped : input.odometry) {
    const Pose T_start_body = T_start_odom * stamped.pose;
    Knot knot;
    knot.t_s = secondsBetween(start_ns_, stamped.t_ns);
    knot.R = T_start_body.rotation;
    knot.p = T_start_body.position;
    if (!knots_.empty()) {
      Knot& last = knots_.back();
      const double dt = knot.t_s - last.t_s;
      last.omega = so3::log(last.R.transpose() * knot.R) / dt;
      last.v = (knot.p - last.p) / dt;
      knot.omega = last.omega;
      knot.v = last.v;
    }
    knots_.push_back(knot);
  }
  v_body_end_ = knots_.back().R.transpose() * knots_.back().v;
}

void ScanMotion::addVelocity(const Vec3& v_start) {
  for (Knot& knot : knots_) {
    knot.p += v_start * knot.t_s;
    knot.v += v_start;
  }
  v_body_end_ = knots_.back().R.transpose() * knots_.back().v;
}

Pose ScanMotion::atStartFrame(double t_s) const {
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), t_s,
                                      [](double t, const Knot& knot) { return t < knot.t_s; });
  if (after == knots_.begin()) return {knots_.front().p, knots_.front().R};
  const Knot& a = *(after - 1);
  if (after == knots_.end()) return {a.p, a.R};
  const Knot& b = *after;
  const double dt = b.t_s - a.t_s, s = t_s - a.t_s;
  if (even_steps_) return {a.p + a.v * s, a.R * so3::exp(a.omega * s)};
  const Vec3 turn = a.omega * s + (b.omega - a.omega) * (s * s / (2 * dt));
  const Vec3 p = a.p + a.v * s + a.a * (s * s / 2) + (b.a - a.a) * (s * s * s / (6 * dt));
  return {p, a.R * so3::exp(turn)};
}

Pose ScanMotion::bodyAt(TimeNs t_ns) const {
  return T_end_start_ * atStartFrame(secondsBetween(start_ns_, t_ns));
}

double ScanMotion::maxRate() const {
  double rate = 0;
  for (const Knot& knot : knots_) rate = std::max(rate, knot.omega.norm());
  return rate;
}

}  // namespace paloc
