#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// Points of a scan, each the mean of the returns about it.
struct AveragedPoints {
  std::vector<Point3f> points;         ///< m, in the frame of the returns
  std::vector<std::uint16_t> returns;  ///< that each is the mean of, at least 1

  /// Every so many-th, so that about `count` are left.
  PALOC_EXPORT AveragedPoints everyNth(std::size_t count) const;
};

/// Averages the returns about some points of a scan. A scanner measures far more points than a
/// registration has the time for; the mean of n returns from one surface has the range noise of one
/// over the square root of n, and costs as much as one.
///
/// Returns belong together by the direction of their rays, which the noise of the range does not
/// change: a neighbourhood in space would take in those that noise has moved into it, and lean
/// towards its middle. Of these, returns whose ranges differ by more than noise explains are from
/// another surface.
class PALOC_EXPORT ScanAveraging {
 public:
  /// One point for each of `seeds` (indices into `returns`, ascending). A return counts for one
  /// seed at most, the nearest; a seed always for itself. `range_noise_m`: one standard deviation.
  /// The same input gives the same output. One object serves one thread.
  AveragedPoints average(std::span<const Point3f> returns, std::span<const std::uint32_t> seeds,
                         const Vec3& sensor_position, double range_noise_m);

 private:
  struct Seed {
    Point3f ray;  ///< from the sensor, m
    float range = 0;
    std::int32_t next = -1;  ///< another seed of the same cell
    float x = 0, y = 0, z = 0;
    int count = 0;
  };

  std::vector<Seed> seeds_;
  std::vector<std::int32_t> first_in_cell_;
};

}  // namespace paloc
