#pragma once

#include <span>
#include <vector>

#include "plane_moments.h"
#include "point_index.h"

namespace paloc {

/// The map points about a place, gathered once and then looked at from several points near it.
/// Coordinates are relative to the place. One object serves one thread.
class Neighbourhood {
 public:
  explicit Neighbourhood(const PointIndex& index) : index_(index) {}

  /// Gathers all points nearer to `centre` than `reach_m`.
  void gather(const Point3f& centre, float reach_m);
  const Point3f& centre() const { return centre_; }
  std::size_t size() const { return size_; }

  /// The square of the distance from `from` to its `count`-th nearest point (the first may be
  /// itself); infinite if there are fewer.
  float distanceSq(const Point3f& from, std::size_t count);

  struct Sums {
    MomentSums sums{};
    int count = 0;
  };
  /// Sums over the points nearer to `from` than that, relative to `from`.
  Sums sumsWithin(const Point3f& from, float radius_sq) const;

  /// These points themselves, relative to `from`, the nearer half first.
  std::span<const Point3f> pointsWithin(const Point3f& from, float radius_sq);

 private:
  struct Neighbour {
    Point3f relative;
    float distance_sq;
  };

  void append(const PointBlock& block, float reach_sq);

  const PointIndex& index_;
  Point3f centre_{};
  std::size_t size_ = 0;
  std::vector<float> x_, y_, z_;  // filled up to whole lanes with points too far away to count
  std::vector<float> distances_sq_;
  std::vector<Neighbour> neighbours_;
  std::vector<Point3f> points_;
};

}  // namespace paloc
