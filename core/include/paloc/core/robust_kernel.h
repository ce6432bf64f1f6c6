#pragma once

#include <cmath>

namespace paloc {

/// Down-weights a whitened residual of squared norm s (iteratively reweighted least squares).
/// Sources: Huber (1964); Cauchy/Lorentzian as in Black and Rangarajan (1996).
struct RobustKernel {
  enum class Kind { kNone, kHuber, kCauchy };

  Kind kind = Kind::kNone;
  double width = 1.345;  ///< in standard deviations

  /// Square root of the weight rho'(s).
  double sqrtWeight(double squared_norm) const {
    const double w_sq = width * width;
    switch (kind) {
      case Kind::kNone:
        break;
      case Kind::kHuber:
        return squared_norm <= w_sq ? 1.0 : std::sqrt(width / std::sqrt(squared_norm));
      case Kind::kCauchy:
        return std::sqrt(1 / (1 + squared_norm / w_sq));
    }
    return 1.0;
  }

  /// The cost rho(s); without a kernel it is s.
  double cost(double squared_norm) const {
    const double w_sq = width * width;
    switch (kind) {
      case Kind::kNone:
        break;
      case Kind::kHuber:
        return squared_norm <= w_sq ? squared_norm : 2 * width * std::sqrt(squared_norm) - w_sq;
      case Kind::kCauchy:
        return w_sq * std::log1p(squared_norm / w_sq);
    }
    return squared_norm;
  }
};

}  // namespace paloc
