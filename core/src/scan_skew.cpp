#include "paloc/core/scan_skew.h"

#include "paloc/core/so3.h"

namespace paloc {
namespace {

constexpr double kMeanAge = 0.5, kSigmaOfAge = 0.25;  // in durations of the scan

void move(const Pose& T_end_then, Scan& scan) {
  const Eigen::Matrix3f rotation = T_end_then.rotation.cast<float>();
  const Eigen::Vector3f position = T_end_then.position.cast<float>();
  for (Point3f& p : scan.points_body) {
    const Eigen::Vector3f at = rotation * Eigen::Vector3f(p.x, p.y, p.z) + position;
    p = {at.x(), at.y(), at.z()};
  }
  scan.sensor_position_body = T_end_then * scan.sensor_position_body;
}

}  // namespace

Scan withSkewTold(const Scan& scan, const Pose& motion, const Mat6& covariance, double dt_s) {
  Scan told = scan;
  if (scan.skew == ScanSkew::kNone) return told;
  const double share = secondsBetween(scan.start_ns, scan.end_ns) / dt_s;
  // In the body frame at the end.
  const Mat3 R_end_begin = motion.rotation.transpose();
  Mat6 turn = Mat6::Identity();
  turn.topLeftCorner<3, 3>() = R_end_begin;
  const double half = kMeanAge * share;
  told.skew_covariance = half * half * (turn * covariance * turn.transpose());
  if (scan.skew == ScanSkew::kWhole) {
    Vec6 whole;
    whole << R_end_begin * motion.position, so3::log(motion.rotation);
    move({-half * whole.head<3>(), so3::exp(-half * whole.tail<3>())}, told);
    const double quarter = kSigmaOfAge * share;
    told.skew_covariance += quarter * quarter * (whole * whole.transpose());
  }
  return told;
}

}  // namespace paloc
