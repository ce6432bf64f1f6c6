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

  /// Makes it quicker to gather what lies within `reach_m` of a place, until the next call; 0:
  /// nothing.
  void prepare(const Point3f& place, float reach_m);
  /// Gathers all points nearer to `centre` than `reach_m`.
  void gather(const Point3f& centre, float reach_m);
  std::size_t size() const { return points_.size(); }

  /// The square of a radius about `from` that holds `count` points (one of them may be `from`
  /// itself) and few more, at most `within_sq`; infinite if that holds fewer. `about_sq`: near to
  /// what is expected.
  float radiusSqOf(std::size_t count, const Eigen::Vector3f& from, float within_sq, float about_sq);

  struct Face {
    MomentSums sums;  // of the points on it, about the place
    int count = 0;    // of all points within the radius
  };
  /// The points nearer to `from` than that whose height over the plane through it is no more than
  /// `within_m` off `height_m`.
  Face faceWithin(const Eigen::Vector3f& from, float radius_sq, const Eigen::Vector3f& normal,
                  float height_m, float within_m) const;

  /// The points nearer to `from` than that, relative to it.
  const NearPoints& pointsWithin(const Eigen::Vector3f& from, float radius_sq);

 private:
  const PointIndex& index_;
  const PointKernels& kernels_ = pointKernels();
  PointIndex::NearBlocks blocks_, groups_;
  Point3f prepared_{};  // groups_ has all groups within prepared_m_ of it
  float prepared_m_ = 0;
  NearPoints points_, selected_;
  std::vector<float> distances_sq_;
};

}  // namespace paloc
