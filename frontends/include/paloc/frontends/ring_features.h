#pragma once

#include <cstdint>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/frontends/lidar_frame.h"

namespace paloc {

/// What counts as a feature.
struct RingFeatureLimits {
  double window_m = 0.3;        ///< way along the ring, to each side of a point, that is looked at
  double edge_bend = 0.3;       ///< an edge bends more
  double plane_bend = 0.2;      ///< a plane bends less
  double range_noise_m = 0.02;  ///< standard deviation of a range
  int edges_per_sector = 3;     ///< at most; a ring has six sectors
};

/// Edge and plane points of a scan whose points tell their ring, after LOAM (J. Zhang and S. Singh,
/// "LOAM: Lidar Odometry and Mapping in Real-time", 2014, section V-A). What differs: the window is
/// as long in metres near and far, and its sums come from running totals, so its length costs
/// nothing.
///
/// The bend of a point: twice the distance from it to the mean of its window, over the mean
/// distance of the window's ends. On a straight line it is 0, at a right angle about 0.7. Windows
/// do not reach over a jump of the range or a gap between returns. At a jump the last point of the
/// near side is an edge as well, but points of the far side near it are none: what hides the rest
/// of their surface is the near one. Where the beam runs along the surface nothing is a feature.
class PALOC_EXPORT RingFeatures {
 public:
  explicit RingFeatures(const RingFeatureLimits& limits) : limits_(limits) {}

  /// Looks at the points of a scan, which have rings and come in the order of their azimuth within
  /// each.
  void extract(const LidarFrame& frame);

  /// Indices of points, ring by ring: those of edges by falling bend within each sector.
  const std::vector<std::uint32_t>& edges() const { return edges_; }
  const std::vector<std::uint32_t>& planes() const { return planes_; }

 private:
  struct Total {
    double x = 0, y = 0, z = 0;
  };
  enum class Link : std::uint8_t { kJoined, kGap, kNearBefore, kNearAfter };  // to the next point
  struct Candidate {
    float bend = 0;
    std::uint32_t at = 0;  // in order_
  };

  void sortByRing(const LidarFrame& frame);
  void extractRing(std::size_t begin, std::size_t end);
  void linkPoints(std::size_t begin, std::size_t end);
  double stepAngle(std::size_t begin, std::size_t end);
  void findRuns(std::size_t begin, std::size_t end);
  void classify(std::size_t at, double step_rad);
  void addSilhouette(std::size_t at, std::size_t inward_end);
  Vec3 meanOf(std::size_t begin, std::size_t end) const;
  Vec3 point(std::size_t at) const;
  void pickEdges(std::size_t begin, std::size_t end);

  RingFeatureLimits limits_;
  std::vector<std::uint32_t> order_, ring_begin_;
  std::vector<Point3f> points_;                     // in that order
  std::vector<float> range_;                        // of these
  std::vector<Total> total_;                        // of the points before each
  std::vector<Link> link_;                          // of each with the next
  std::vector<std::uint32_t> run_begin_, run_end_;  // of the joined points about each
  std::vector<Candidate> candidates_;               // of one ring
  std::vector<std::uint16_t> reach_;                // points to each side of the window of each
  std::vector<char> taken_;                         // near an edge that was picked
  std::vector<float> angles_;
  std::vector<std::uint32_t> edges_, planes_;
};

}  // namespace paloc
