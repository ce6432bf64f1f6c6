#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "paloc/frontends/local_voxel_map.h"
#include "paloc/frontends/point_to_plane_sums.h"

namespace paloc {

/// A point of a scan where an odometry believes it to be.
struct PlacedPoint {
  Vec3 point_odom = Vec3::Zero();  ///< m
  Vec3 lever = Vec3::Zero();       ///< of PointToPlane
  Vec3 ray = Vec3::Zero();         ///< sensor to point, odom frame (m)
  double age_s = 0;                ///< before the end of the scan
  double sag_s2 = 0;               ///< of PointToPlane
};

/// The points of a scan that have a plane in the local map, with the standard deviation of each
/// residual, and robust weights.
///
/// The error of a plane, which its points share, is not counted: scans that follow each other are
/// matched to the same planes, so it cancels in the motion between them. (With it, as a variance
/// added to that of each point, drift was larger and the covariance the same.)
class PALOC_EXPORT PlaneMatches {
 public:
  explicit PlaneMatches(double noise_floor_m) : noise_floor_m_(noise_floor_m) {}

  void associate(std::span<const PlacedPoint> points, const LocalVoxelMap& map, double gate_m,
                 double least_voxel_m = 0);
  /// Leaves every point on the plane that it has: the points where another state puts them, all of
  /// them and in the same order.
  void move(std::span<const PlacedPoint> points);
  std::size_t size() const { return rows_.size(); }

  /// Sets the weights, 1 / variance times that of the kernel of Geman and McClure. `widening_m` is
  /// added to the kernel's width: at first, while the pose is not sure. Variances are multiplied
  /// by that of the residuals, robustly told, in units of what is expected of them. `unsure_m` is a
  /// standard deviation that every residual has besides.
  void weigh(double widening_m, double unsure_m = 0);

  /// Normal equations of all rows (see jacobianOf for `ageing`).
  template <int N>
  PointToPlaneSums<N> sums(double ageing) const;
  /// What the noise of normals alone would give.
  template <int N>
  Eigen::Matrix<double, N, N> normalNoise(double ageing) const;
  /// Sum of n n^T over the normals of all rows.
  Mat3 normals() const;

 private:
  struct Row {
    PointToPlane point;
    double offset = 0;                                  // n . c
    std::uint32_t index = 0;                            // of the point
    double thickness = 0, width = 1, plane_points = 1;  // of the plane
    double sigma = 1, normal_variance = 0;  // of the residual (m), of the normal (rad^2)
    double weight = 0;
  };

  void setDeviations();
  double robustScale();

  double noise_floor_m_;
  std::vector<Row> rows_;
  std::vector<double> scratch_;
};

}  // namespace paloc
