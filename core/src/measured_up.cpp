#include "paloc/core/measured_up.h"

namespace paloc {

std::optional<Vec3> measuredUp(const ImuBuffer& imu, TimeNs t_ns,
                               const EstimatorSettings& settings) {
  for (const double window_s : {3.0, 1.0, 0.3, 0.1}) {
    const auto felt = imu.integrate(t_ns - nsFromSeconds(window_s), t_ns, settings.max_imu_gap_s,
                                    settings.imu, Vec3::Zero(), Vec3::Zero());
    // delta_v is the sum of the specific force, in the body frame of the window's start.
    if (felt && felt->delta_v.norm() > 0) {
      return (felt->delta_R.transpose() * felt->delta_v).normalized();
    }
  }
  return std::nullopt;
}

}  // namespace paloc
