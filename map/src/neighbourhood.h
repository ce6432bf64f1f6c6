#pragma once

#include <vector>

#include "near_points.h"
#include "point_index.h"

namespace paloc {

/// The map points about a place, gathered once and then looked at from several points near it.
/// Coordinates are relative to the place. One object serves one thread.
class Neighbourhood {
 public:
  explicit Neighbourhood(const PointIndex& index) : index_(index) {}

  /// Gathers all points nearer to `centre` than `reach_m`.
  void gather(const Point3f& centre, float reach_m);
  std::size_t size() const { return points_.size(); }

  /// The square of a radius about `from` that holds `count` points (one of them may be `from`
  /// itself) and few more, at most `within_sq`; infinite if that holds fewer. `about_sq`: near to
  /// what is expected.
  float radiusSqOf(std::size_t count, const Eigen::Vector3f& from, float within_sq, float about_sq);

  /// Moments, about `from`, of the points nearer to it than that.
  MomentSums sumsWithin(const Eigen::Vector3f& from, float radius_sq) const;

  struct Face {
    MomentSums sums;  // of the points on it, about the place
    int count = 0;    // of all points within the radius
  };
  /// The points nearer to `from` than that whose height over the plane through it is no more than
  /// `within_m` off `height_m`.
  Face faceWithin(const Eigen::Vector3f& from, float radius_sq, const Eigen::Vector3f& normal,
                  float height_m, float within_m) const;

  /// These points themselves, relative to `from`.
  const NearPoints& pointsWithin(const Eigen::Vector3f& from, float radius_sq);

 private:
  std::size_t countWithin(float radius_sq) const;

  const PointIndex& index_;
  NearPoints points_, selected_;
  std::vector<float> distances_sq_;
};

}  // namespace paloc
