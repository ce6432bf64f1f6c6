#include "paloc/frontends/odometry_track.h"

#include <algorithm>

namespace paloc {
namespace {

// Steps shorter than this are judged as if they took this long: the noise of a fast stream is no
// jump.
constexpr double kShortestJudgedStep = 0.01;  // s

}  // namespace

int OdometryTrack::stretchOfNext(const OdometryPose& pose) {
  if (poses_.empty()) return 0;
  const Entry& last = poses_.back();
  const double dt_s = secondsBetween(last.pose.t_ns, pose.t_ns);
  if (dt_s > limits_.max_gap_s) {
    ++gaps_;
    longest_gap_s_ = std::max(longest_gap_s_, dt_s);
    return last.stretch + 1;
  }
  const Pose motion = last.pose.T_odom_body.inverse() * pose.T_odom_body;
  const double judged_s = std::max(dt_s, kShortestJudgedStep);
  if (motion.position.norm() > limits_.max_speed_mps * judged_s ||
      so3::log(motion.rotation).norm() > limits_.max_rate_radps * judged_s) {
    ++jumps_;
    return last.stretch + 1;
  }
  return last.stretch;
}

void OdometryTrack::add(const OdometryPose& pose) {
  const int stretch = stretchOfNext(pose);
  poses_.push_back({pose, stretch});
}

std::size_t OdometryTrack::lowerBound(TimeNs t_ns) const {
  const auto found =
      std::lower_bound(poses_.begin(), poses_.end(), t_ns,
                       [](const Entry& entry, TimeNs t) { return entry.pose.t_ns < t; });
  return static_cast<std::size_t>(found - poses_.begin());
}

std::optional<OdometryTrack::Lookup> OdometryTrack::extrapolate(TimeNs t_ns,
                                                                std::size_t last) const {
  if (last == 0 || poses_[last - 1].stretch != poses_[last].stretch) return std::nullopt;
  const OdometryPose &a = poses_[last - 1].pose, &b = poses_[last].pose;
  if (secondsBetween(b.t_ns, t_ns) > limits_.max_extrapolation_s) return std::nullopt;
  const double ratio = secondsBetween(a.t_ns, t_ns) / secondsBetween(a.t_ns, b.t_ns);
  return Lookup{interpolate(a.T_odom_body, b.T_odom_body, ratio), poses_[last].stretch, true};
}

std::optional<OdometryTrack::Lookup> OdometryTrack::at(TimeNs t_ns) const {
  const std::size_t next = lowerBound(t_ns);
  if (next < poses_.size() && poses_[next].pose.t_ns == t_ns) {
    return Lookup{poses_[next].pose.T_odom_body, poses_[next].stretch, false};
  }
  if (next == 0) return std::nullopt;
  if (next == poses_.size() || poses_[next].stretch != poses_[next - 1].stretch) {
    return extrapolate(t_ns, next - 1);
  }
  const OdometryPose &a = poses_[next - 1].pose, &b = poses_[next].pose;
  const double ratio = secondsBetween(a.t_ns, t_ns) / secondsBetween(a.t_ns, b.t_ns);
  return Lookup{interpolate(a.T_odom_body, b.T_odom_body, ratio), poses_[next].stretch, false};
}

std::vector<OdometryPose> OdometryTrack::between(TimeNs from_ns, TimeNs to_ns) const {
  std::vector<OdometryPose> result;
  for (std::size_t i = lowerBound(from_ns + 1); i < poses_.size(); ++i) {
    if (poses_[i].pose.t_ns >= to_ns) break;
    result.push_back(poses_[i].pose);
  }
  return result;
}

std::optional<Mat6> OdometryTrack::motionCovariance(TimeNs from_ns, TimeNs to_ns) const {
  const auto from = at(from_ns), to = at(to_ns);
  if (!from || !to || from->stretch != to->stretch) return std::nullopt;
  const Mat3 R_from_odom = from->T_odom_body.rotation.transpose();
  Mat6 sum = Mat6::Zero();
  std::size_t i = std::max<std::size_t>(1, lowerBound(from_ns + 1));
  if (i >= poses_.size()) i = poses_.size() - 1;  // wholly extrapolated: by the last step
  for (; i < poses_.size() && poses_[i - 1].pose.t_ns < to_ns; ++i) {
    const OdometryPose &a = poses_[i - 1].pose, &b = poses_[i].pose;
    if (!b.step_covariance) return std::nullopt;
    const bool last = i + 1 == poses_.size();
    const TimeNs end = last ? to_ns : std::min(b.t_ns, to_ns);
    const double share =
        secondsBetween(std::max(a.t_ns, from_ns), end) / secondsBetween(a.t_ns, b.t_ns);
    if (!(share > 0)) continue;
    // An error (dp, w) of pose b moves the end by dp + R_b (w x r), and turns it by R_b_end^T w.
    const Pose T_b_to = b.T_odom_body.inverse() * to->T_odom_body;
    Mat6 j = Mat6::Zero();
    j.topLeftCorner<3, 3>() = R_from_odom;
    j.topRightCorner<3, 3>() = -R_from_odom * b.T_odom_body.rotation * so3::hat(T_b_to.position);
    j.bottomRightCorner<3, 3>() = T_b_to.rotation.transpose();
    sum += share * (j * *b.step_covariance * j.transpose());
  }
  return sum;
}

void OdometryTrack::forgetBefore(TimeNs t_ns) {
  // Two poses before are kept: extrapolation and the step's covariance need them.
  while (poses_.size() > 3 && poses_[2].pose.t_ns < t_ns) poses_.pop_front();
}

}  // namespace paloc
