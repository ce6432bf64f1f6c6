#pragma once

#include <array>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/map/degeneracy.h"
#include "paloc/map/map_information.h"

namespace paloc {

/// The normal equations of independent residuals, row by row (see PlaneRow).
class EquationSums {
 public:
  void add(const Vec3& n, const Vec3& p, double residual, double weight) {
    const double j[6] = {n.x(),
                         n.y(),
                         n.z(),
                         p.y() * n.z() - p.z() * n.y(),
                         p.z() * n.x() - p.x() * n.z(),
                         p.x() * n.y() - p.y() * n.x()};
    std::size_t at = 0;
    for (std::size_t row = 0; row < 6; ++row) {
      const double weighted = weight * j[row];
      for (std::size_t column = row; column < 6; ++column) upper_[at++] += weighted * j[column];
      gradient_[row] += weighted * residual;
    }
  }

  NormalEquations equations() const {
    NormalEquations equations;
    std::size_t at = 0;
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        equations.information(row, column) = equations.information(column, row) = upper_[at++];
      }
      equations.gradient[row] = gradient_[static_cast<std::size_t>(row)];
    }
    return equations;
  }

 private:
  std::array<double, 21> upper_{};
  std::array<double, 6> gradient_{};
};

/// Directions that are held at the start, as rows of a prior.
class Anchors {
 public:
  /// Those of the observed ones that the map does not fix.
  void hold(const ObservedDirections& observed);
  void addTo(NormalEquations& equations, const Vec6& from_start) const;

 private:
  std::vector<Vec6> axes_;
};

/// The Gauss-Newton step in the tangent of PlaneRow, no longer than is believed (0.5 m, 0.2 rad);
/// false when there is none.
bool solveStep(const NormalEquations& equations, Vec6& step);

}  // namespace paloc
