#pragma once

#include <numbers>
#include <random>

#include "paloc/core/state.h"

namespace paloc {

/// Random states for the tests of factors: anywhere, near to each other, and turned against each
/// other by almost half a turn, where logarithms are delicate.
class RandomStates {
 public:
  explicit RandomStates(unsigned seed) : rng_(seed) {}

  double normal(double sigma = 1) { return sigma * normal_(rng_); }
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(rng_);
  }
  std::size_t below(std::size_t n) { return rng_() % n; }
  Vec3 vector(double sigma = 1) { return {normal(sigma), normal(sigma), normal(sigma)}; }
  Vec3 direction() { return vector().normalized(); }
  Mat3 rotation() { return so3::exp(uniform(0, std::numbers::pi) * direction()); }
  Pose pose() { return {vector(5), rotation()}; }

  State state() {
    State x;
    x.T_map_body = pose();
    x.v_map = vector(2);
    x.bias_acc = vector(0.1);
    x.bias_gyro = vector(0.02);
    x.gravity_map = (-Vec3::UnitZ() + vector(0.05));
    return x;
  }

  /// A state beside `x`; `size` is the standard deviation of each component.
  State near(const State& x, double size) {
    StateVector delta;
    for (int k = 0; k < tangent::kDim; ++k) delta[k] = normal(size);
    return boxplus(x, delta);
  }

  /// A state turned against `x` by half a turn but for 1 to 10 mrad.
  State oppositeOf(const State& x) {
    State y = state();
    const double angle = std::numbers::pi - uniform(1e-3, 1e-2);
    y.T_map_body.rotation = x.T_map_body.rotation * so3::exp(angle * direction());
    return y;
  }

  /// One of the three, by turns.
  State relatedTo(const State& x, int trial) {
    if (trial % 3 == 0) return state();
    return trial % 3 == 1 ? near(x, trial % 2 == 0 ? 1e-9 : 1e-3) : oppositeOf(x);
  }

  /// A random symmetric positive definite matrix with standard deviations about `sigma`.
  Mat6 covariance(double sigma) {
    Mat6 a;
    for (int k = 0; k < a.size(); ++k) a.data()[k] = normal(sigma);
    return a * a.transpose() + 0.1 * sigma * sigma * Mat6::Identity();
  }

 private:
  std::mt19937_64 rng_;
  std::normal_distribution<double> normal_;
};

}  // namespace paloc
