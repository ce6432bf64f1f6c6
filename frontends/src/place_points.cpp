#include "paloc/frontends/place_points.h"

namespace paloc {

void placePoints(std::span<const MeasuredPoint> points, const FreeFallScan& scan,
                 const Vec3& sensor_body, const LioState& x, double ageing,
                 std::vector<PlacedPoint>& placed) {
  const Mat3& R = x.T_odom_body.rotation;
  const Vec3 sensor_odom = R * sensor_body;  // near enough for a ray
  placed.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double tau = points[i].age_s;
    const Vec3 lever = R * scan.place(points[i].point_body, tau);
    const Vec3 moved = ageing * tau * (0.5 * tau * x.gravity_odom - x.v_odom);
    placed[i] = {x.T_odom_body.position + moved + lever, lever, lever - sensor_odom, tau, 0};
  }
}

void placePoints(std::span<const MeasuredPoint> points, const FreeFallScan& scan,
                 const Vec3& sensor_body, const CalibratedLioState& s, double ageing,
                 std::vector<PlacedPoint>& placed) {
  const LioState& x = s.x;
  const Mat3& R = x.T_odom_body.rotation;
  const Vec3 sensor = sensor_body + s.calibration.moved_body;
  const Vec3 sensor_odom = R * sensor;  // near enough for a ray
  const double later_s = scan.durationS() > 0 ? s.calibration.imu_late_s : 0;
  placed.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double tau = points[i].age_s, aged = ageing * tau;
    const Vec3 point = sensor + s.calibration.R * (points[i].point_body - sensor_body);
    const Vec3 lever = R * (scan.place(point, tau) + later_s * scan.velocity(point, tau));
    const Vec3 moved = aged * (0.5 * tau * x.gravity_odom - x.v_odom) +
                       later_s * (x.v_odom - aged * x.gravity_odom);
    placed[i] = {x.T_odom_body.position + moved + lever, lever, lever - sensor_odom, tau, 0};
  }
}

}  // namespace paloc
