#pragma once

#include <array>
#include <span>
#include <vector>

#include "lanes4.h"
#include "paloc/map/degeneracy.h"

namespace paloc {

/// What rows know of a motion.
struct Support {
  double count = 0;                     // of constraining rows
  double signal = 0;                    // information along it
  double noise_mean = 0, variance = 0;  // that noise alone would give, and of the signal
  double unweighted = 0;                // the signal without robust weights
  double squares = 0;                   // of what each row adds to the signal

  /// That many rows, each telling as much, would be as concentrated.
  double effectiveRows() const { return squares > 0 ? signal * signal / squares : 0; }
};

/// Rows, four side by side in single precision, to be asked what they know of motions.
class SupportRows {
 public:
  /// `normal_noise_rad`: standard deviation of a map normal beyond what its fit tells.
  SupportRows(std::span<const PlaneRow> rows, double normal_noise_rad);

  /// The information that errors of the normals alone would give a translation along any axis, and
  /// a rotation about any.
  double noiseOfTranslation() const { return normal_noise_; }
  double noiseOfRotation() const { return levered_noise_; }

  std::array<Support, 3> of(const std::array<Motion, 3>& motions) const;

 private:
  struct Lanes {
    Float4 normal[3], point[3];
    Float4 weight, unweighted;  // one over the variance, with the robust weight and without
    Float4 normal_var, range_var;
  };
  struct Sums {
    Float4 count{}, signal{}, noise_mean{}, variance{}, unweighted{}, squares{};
  };
  static void add(const Lanes& rows, const Motion& motion, Sums& sums);

  std::vector<Lanes> lanes_;
  double normal_noise_ = 0, levered_noise_ = 0;
};

}  // namespace paloc
