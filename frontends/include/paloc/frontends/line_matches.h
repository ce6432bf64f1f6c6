#pragma once

#include <array>
#include <span>
#include <vector>

#include "paloc/frontends/line_voxels.h"
#include "paloc/frontends/plane_matches.h"

namespace paloc {

/// The distance of a point from a line, as two residuals: from two planes through the line that
/// stand on each other. Their normals are fixed by the line's direction alone.
PALOC_EXPORT std::array<PointToPlane, 2> pointToLine(const PlacedPoint& point,
                                                     const LocalLine& line);

/// The edge points of a scan that have a line in the local map, weighed as those of PlaneMatches
/// are.
class PALOC_EXPORT LineMatches {
 public:
  explicit LineMatches(double noise_floor_m) : noise_floor_m_(noise_floor_m) {}

  void associate(std::span<const PlacedPoint> points, const LineVoxels& map, double gate_m);
  std::size_t size() const { return rows_.size(); }

  /// See PlaneMatches::weigh.
  void weigh(double widening_m);

  /// Adds to normal equations (see jacobianOf for `ageing`).
  void addTo(PointToPlaneSums<9>& sums, double ageing) const;
  /// Adds what the noise of directions alone would give to that of normals.
  void addNoiseTo(Mat9& noise, double ageing) const;

 private:
  struct Row {
    std::array<PointToPlane, 2> residuals;
    double variance = 1, direction_variance = 0;  // of each residual (m2), of the line (rad2)
    double weight = 0;
    double squared() const {
      return residuals[0].residual * residuals[0].residual +
             residuals[1].residual * residuals[1].residual;
    }
  };

  double robustVariance();

  double noise_floor_m_;
  std::vector<Row> rows_;
  std::vector<double> scratch_;
};

}  // namespace paloc
