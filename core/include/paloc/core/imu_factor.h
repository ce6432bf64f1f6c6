#pragma once

#include "paloc/core/linearization.h"
#include "paloc/core/preintegration.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// IM, the preintegrated IMU factor between two neighbouring nodes (the bias walk is a factor of
/// its own). PALoc, section on IMU factors; Forster et al. (2017), equations 37 and 38, with
/// gravity a state: G (m/s2) times the unit vector g that points down.
///
///   r = [ R_i^T (t_j - t_i - v_i dt - G g_i dt^2 / 2) - dp(b_i) ;
///         Log(dR(b_i)^T R_i^T R_j) ;
///         R_i^T (v_j - v_i - G g_i dt) - dv(b_i) ]          (9, [m, rad, m/s] in body i)
class PALOC_EXPORT ImuFactor {
 public:
  /// `gravity_mps2`: the local strength G of gravity.
  ImuFactor(const Preintegration& preintegration, double gravity_mps2);

  EdgeLinearization<9> linearize(const State& i, const State& j) const;
  RobustKernel kernel() const { return {}; }

  /// The state at the end when the motion starts from `i`.
  State predict(const State& i) const;

 private:
  struct Corrected {
    Vec3 delta_p, delta_v, rotation_correction;
    Mat3 delta_R;
  };
  Corrected correctFor(const State& i) const;

  Preintegration preintegration_;
  Preintegration::Covariance sqrt_information_;
  double gravity_mps2_;
};

}  // namespace paloc
