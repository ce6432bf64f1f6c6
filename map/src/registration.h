#pragma once

#include <tbb/task_arena.h>

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "matched_lanes.h"
#include "motion_probe.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/pose.h"
#include "paloc/map/degeneracy.h"
#include "paloc/map/map_information.h"
#include "paloc/map/matcher_settings.h"
#include "paloc/map/prior_map.h"
#include "paloc/map/scan_averaging.h"
#include "paloc/map/surface_patches.h"
#include "plane_search.h"

namespace paloc {

/// How one alignment goes: gates on the distance from a point to its map point.
struct AlignSchedule {
  double first_gate_m = 0.5;
  int first_iterations = 2;
  double gate_m = 0.2;
  int max_iterations = 20;
  /// Of the start (m). Where it is large the few points that could correct it are far off their
  /// planes: the kernel begins as wide as that, and narrows.
  double start_sigma_m = 0;
};

/// Time of the parts of an alignment, over all iterations (s).
struct AlignTiming {
  double association_s = 0, solve_s = 0;
};

/// What an alignment came to.
struct Alignment {
  AlignTiming timing;
  Pose T_local_body;
  bool converged = false;
  int iterations = 0;
  int near = 0;     ///< points with any map point within the last gate
  int matched = 0;  ///< points with a plane
  int inliers = 0;  ///< matched points within three robust standard deviations
  double residual_rms_m = 0, residual_median_m = 0;
};

/// Point-to-plane Gauss-Newton on SE(3) of one thinned scan against the map, in the map's local
/// frame. The correspondences, their order and every sum are the same on any number of threads.
class Registration {
 public:
  Registration(const PriorMap& map, const MatcherSettings& settings, tbb::task_arena& arena)
      : settings_(settings), arena_(arena), planes_(map, settings) {}

  /// The points (body frame, m) to be registered next, how many returns each is the mean of, and
  /// where their rays start.
  void setPoints(AveragedPoints averaged_body, const Vec3& sensor_position_body) {
    planes_.setPoints(std::move(averaged_body), sensor_position_body);
  }
  const std::vector<Point3f>& points() const { return planes_.averaged().points; }
  const AveragedPoints& averaged() const { return planes_.averaged(); }
  const Vec3& sensorPosition() const { return planes_.sensorPosition(); }

  /// Registers the points from a start. A direction that the map does not fix is held at the start.
  Alignment align(const Pose& start, const AlignSchedule& schedule);

  /// Rows of the last alignment, at its result.
  const std::vector<PlaneRow>& rows() const { return rows_; }
  /// Whether the points would lie worse with the body moved from there.
  MotionProbe::Answer probe(const Motion& motion) const;
  struct Shared {
    Mat6 spread;  // sharedSpread()
    std::vector<SurfacePatch> patches;
  };
  /// What the errors that these share do; gives each row its patch.
  Shared sharedErrorsOfRows();

 private:
  // So small that the first steps, too, are shared among threads.
  static constexpr std::size_t kChunk = PlaneSearch::kMost;

  /// Of a chunk of points those with a plane, ascending, and how many have any map point near.
  struct Collected {
    std::array<std::uint32_t, kChunk> matched;
    std::uint32_t count;
    int near;
  };
  void associate(const Pose& pose, double gate, int iteration, std::size_t stride);
  void collect(std::size_t begin, std::size_t end, std::size_t stride, double gate,
               Collected& collected) const;
  void joinCollected();
  void fillLanes(const Pose& pose);
  bool holdsAt(const Pose& pose, double gate, std::size_t stride) const;
  double robustScale(std::size_t sample);
  void fillRows(const Pose& pose, double scale);
  PlaneRow rowOf(std::size_t point, const Mat3& R_body_local, double scale) const;
  std::vector<PlaneRow> unweightedRows(const Pose& pose, double scale, std::size_t step) const;
  std::array<MatchDirection, 6> glimpse(const Pose& pose, double scale) const;
  void summarize(double scale, Alignment& alignment);

  const MatcherSettings& settings_;
  tbb::task_arena& arena_;
  PlaneSearch planes_;
  std::vector<Correspondence> matches_;
  std::vector<Collected> collected_;
  std::vector<std::uint32_t> matched_;  // points with a plane, ascending
  MatchedLanes lanes_;                  // of these, at the pose of the last step
  // Where, for which of the points and within what distance planes were sought last.
  struct {
    Pose pose;
    std::size_t stride = 0;
    double gate = 0;
  } association_;
  std::uint32_t alignments_ = 0;  // so far
  struct {
    Pose pose;
    double scale = 1, gate = 0;
  } result_;                    // of the last alignment
  std::vector<PlaneRow> rows_;  // one per matched point
  std::vector<float> scratch_;
  int near_ = 0;
};

}  // namespace paloc
