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

}  // namespace paloc
