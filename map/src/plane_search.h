#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/core/types.h"
#include "paloc/map/matcher_settings.h"
#include "paloc/map/prior_map.h"
#include "paloc/map/scan_averaging.h"

namespace paloc {

/// What a point of the scan was matched with.
struct Correspondence {
  std::uint32_t alignment = 0;  // in which it was sought
  Vec3 searched_at = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // of the plane, local frame
  double height = 0;           // the plane is normal . x = height
  Vec3 map_point = Vec3::Zero();
  double distance = 0;      // to the map point, when searched
  double fit_variance = 0;  // of the plane's height at its centroid
  double normal_sigma = 0;
  double surface_sigma = 0;
  double radius = 0;               // of what the plane was fitted to (m)
  double residual = 0, sigma = 0;  // at the last pose, unweighted
  double range_factor = 0;         // normal . ray
  std::uint32_t map_index = PriorMap::kNoPoint;
  bool near = false, planar = false;
};

/// The planes of the map that the points of a thinned scan lie on, in the map's local frame.
class PlaneSearch {
 public:
  static constexpr std::size_t kMost = 64;  // points sought at once

  PlaneSearch(const PriorMap& map, const MatcherSettings& settings)
      : map_(map), settings_(settings) {}

  /// The points (body frame, m), how many returns each is the mean of, and where their rays start.
  void setPoints(AveragedPoints averaged_body, const Vec3& sensor_position_body);
  const AveragedPoints& averaged() const { return points_; }
  std::size_t size() const { return points_.points.size(); }
  Vec3 point(std::size_t i) const;  ///< body frame (m)
  const Vec3& sensorPosition() const { return sensor_body_; }
  double rangeVariance(std::size_t i) const { return range_variance_[i]; }  ///< m2
  double reach() const { return reach_m_; }  ///< of the farthest point from the body (m)

  /// Matches some points, kMost at most, anew: each at where its match says it is searched.
  void search(std::span<Correspondence* const> matches, const Pose& T_local_body,
              double within_m) const;
  /// Residual and its standard deviation at a position (local), from the noise of the range and of
  /// the plane.
  void measure(Correspondence& match, std::size_t point, const Vec3& position,
               const Mat3& R_local_body) const;

 private:
  void take(Correspondence& match, const PriorMap::Nearest& nearest, const Vec3& from_sensor) const;
  bool liesWhereHit(const Correspondence& match, const Vec3& sensor) const;

  const PriorMap& map_;
  const MatcherSettings& settings_;
  AveragedPoints points_;
  std::vector<Vec3> rays_;              // unit, body frame
  std::vector<double> range_variance_;  // of each point (m2)
  Vec3 sensor_body_ = Vec3::Zero();
  double reach_m_ = 0;
};

}  // namespace paloc
