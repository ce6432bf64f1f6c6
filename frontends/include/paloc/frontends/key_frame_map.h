#pragma once

#include <deque>
#include <span>
#include <vector>

#include "paloc/frontends/line_voxels.h"
#include "paloc/frontends/local_voxel_map.h"
#include "paloc/frontends/plane_matches.h"

namespace paloc {

/// How fine a local map of key frames is and how much it keeps.
struct KeyFrameLimits {
  double voxel_m = 0.2;  ///< as of LocalMapSettings, for planes
  double level_factor = 2.5;
  int levels = 3;
  double line_voxel_m = 0.5;
  std::size_t max_key_frames = 60;
  double max_distance_m = 60;  ///< those further away are the first to be forgotten
};

/// The surroundings as the last key frames saw them: their plane points in voxels, their edge
/// points likewise. Memory is bounded: with too many, those far away are forgotten, then the
/// oldest, until three quarters are left, and the voxels are filled anew with what is kept.
class PALOC_EXPORT KeyFrameMap {
 public:
  explicit KeyFrameMap(const KeyFrameLimits& limits);

  /// Adds the features of a scan, in the map's frame, seen from the end of their rays.
  void add(std::span<const PlacedPoint> planes, std::span<const PlacedPoint> edges);
  /// Puts the features of the first key frame elsewhere, where a better motion puts them.
  void replaceFirst(std::span<const PlacedPoint> planes, std::span<const PlacedPoint> edges);

  const LocalVoxelMap& planes() const { return planes_; }
  const LineVoxels& lines() const { return lines_; }
  std::size_t keyFrames() const { return frames_.size(); }

  void clear();
  std::size_t bytes() const;

 private:
  struct KeyFrame {
    Vec3 sensor = Vec3::Zero();          // map's frame (m)
    std::vector<Point3f> planes, edges;  // from the sensor, along the map's axes
  };

  static KeyFrame keyFrameOf(std::span<const PlacedPoint> planes,
                             std::span<const PlacedPoint> edges);
  void fill(const KeyFrame& frame);
  void refill();
  void forget();

  KeyFrameLimits limits_;
  std::deque<KeyFrame> frames_;  // oldest first
  LocalVoxelMap planes_;
  LineVoxels lines_;
};

}  // namespace paloc
