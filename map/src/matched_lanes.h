#pragma once

#include <tbb/task_arena.h>

#include <vector>

#include "lanes4.h"
#include "paloc/core/pose.h"
#include "paloc/map/map_information.h"

namespace paloc {

/// Points on their planes, four side by side in single precision, for the steps of a registration
/// that look for no planes anew: of each the residual at a reference pose and, exactly, what it
/// becomes at another pose near it. Beside the reference pose all lengths are small, so that single
/// precision is enough anywhere in a map.
class MatchedLanes {
 public:
  /// So many points, to be put at poses near `reference`.
  void reset(std::size_t size, const Pose& reference);
  /// The point (body frame, m), the unit normal of its plane in the body frame at the reference
  /// pose, the residual there (m) and its variance (m2). Different points may be set from different
  /// threads where they are not of the same four.
  void set(std::size_t i, const Vec3& point, const Vec3& normal, double residual, double variance);
  std::size_t size() const { return size_; }

  /// Residuals at another pose.
  void moveTo(const Pose& pose);
  float residual(std::size_t i) const { return lanes_[i / 4].residual[i % 4]; }  ///< m
  float variance(std::size_t i) const { return lanes_[i / 4].variance[i % 4]; }  ///< m2

  /// Least squares of independent residuals, in the tangent of PlaneRow at the pose moved to. The
  /// kernel of Geman and McClure is `kernel` standard deviations wide, each `scale` times what was
  /// set, and `widening_m` wider.
  NormalEquations equations(double kernel, double scale, double widening_m,
                            tbb::task_arena& arena) const;

 private:
  struct Lanes {
    Float4 normal[3], point[3];
    Float4 at_reference, residual;
    Float4 variance;
  };
  NormalEquations equationsOf(std::size_t begin, std::size_t end, float kernel_sq, float scale_sq,
                              float widening_sq) const;

  std::vector<Lanes> lanes_;
  std::size_t size_ = 0;
  Pose reference_;
  Mat3 turned_ = Mat3::Identity();  // from the body at the pose to that at the reference pose
};

}  // namespace paloc
