#include "paloc/core/scan_correction.h"

namespace paloc {

Scan deskewedAnew(const Scan& scan, const Vec3& v_body, const Vec3& bias_gyro) {
  Scan anew = scan;
  anew.v_body_assumed = v_body;
  const Eigen::Vector3f b = bias_gyro.cast<float>();
  const Eigen::Vector3f v = (v_body - scan.v_body_assumed.value_or(v_body)).cast<float>();
  for (std::size_t i = 0; i < anew.ages_s.size(); ++i) {
    const float age = anew.ages_s[i];
    Point3f& p = anew.points_body[i];
    p = {p.x + age * (b.y() * p.z - b.z() * p.y - v.x()),
         p.y + age * (b.z() * p.x - b.x() * p.z - v.y()),
         p.z + age * (b.x() * p.y - b.y() * p.x - v.z())};
  }
  return anew;
}

OdometryFrame withScanDeskewedAnew(const OdometryFrame& frame, const NodeEstimate& last,
                                   const State& predicted) {
  OdometryFrame better = frame;
  if (!frame.scan || !frame.scan->v_body_assumed) return better;
  Vec3 v_body = predicted.T_map_body.rotation.transpose() * predicted.v_map;
  if (frame.continues) {
    const double dt_s = secondsBetween(last.t_ns, frame.t_ns);
    const double by_imu =
        last.covariance.block<3, 3>(tangent::kVelocity, tangent::kVelocity).trace();
    const double by_odometry =
        frame.motion_covariance.topLeftCorner<3, 3>().trace() / (dt_s * dt_s);
    v_body += by_imu / (by_imu + by_odometry) * (*frame.scan->v_body_assumed - v_body);
  }
  better.scan =
      std::make_shared<const Scan>(deskewedAnew(*frame.scan, v_body, predicted.bias_gyro));
  return better;
}

}  // namespace paloc
