#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

/// Calls job(0), ..., job(count - 1), in any order, on several threads at once or not.
using RunJobs = std::function<void(std::size_t count, const std::function<void(std::size_t)>& job)>;
PALOC_EXPORT void inTurn(std::size_t count, const std::function<void(std::size_t)>& job);

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
  /// The same input gives the same output, however the jobs are run. One object serves one caller.
  AveragedPoints average(std::span<const Point3f> returns, std::span<const std::uint32_t> seeds,
                         const Vec3& sensor_position, double range_noise_m,
                         const RunJobs& run = inTurn);

 private:
  struct Seed {
    Point3f ray;  ///< from the sensor, m
    float range = 0;
    std::int32_t next = -1;  ///< another seed of the same cell
  };
  /// Returns that count for one seed, from its own.
  struct Sum {
    float x = 0, y = 0, z = 0;
    int count = 0;
  };

  void sortSeeds(std::span<const Point3f> returns, std::span<const std::uint32_t> seeds,
                 const Point3f& sensor);
  void sumUp(std::span<const Point3f> returns, const Point3f& sensor, float same_range,
             std::span<Sum> sums) const;

  std::vector<Seed> seeds_;
  std::vector<std::int32_t> first_in_cell_;
  std::vector<Sum> sums_;  // for each seed, of one part of the returns after the other
};

}  // namespace paloc
