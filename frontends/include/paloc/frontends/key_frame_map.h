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
/// points likewise. Memory is bounded: with too many, the oldest are forgotten until three quarters
/// are left, and those that were far away.
///
/// What is in a voxel cannot be told apart again, so the voxels of those that are left are filled
/// anew, and beforehand: some key frames with each that is added, lest one scan pays for all.
class PALOC_EXPORT KeyFrameMap {
 public:
  explicit KeyFrameMap(const KeyFrameLimits& limits);

  /// Adds the features of a scan, in the map's frame, seen from the end of their rays.
  void add(std::span<const PlacedPoint> planes, std::span<const PlacedPoint> edges);
  /// Puts the features of the first key frame elsewhere, where a better motion puts them, unless it
  /// is forgotten.
  void replaceFirst(std::span<const PlacedPoint> planes, std::span<const PlacedPoint> edges);

  const LocalVoxelMap& planes() const { return now_.planes; }
  const LineVoxels& lines() const { return now_.lines; }
  std::size_t keyFrames() const { return frames_.size(); }
  /// How many key frames the last add() has put into voxels: what it cost.
  std::size_t filled() const { return filled_; }

  void clear();
  std::size_t bytes() const;

 private:
  struct KeyFrame {
    Vec3 sensor = Vec3::Zero();          // map's frame (m)
    std::vector<Point3f> planes, edges;  // from the sensor, along the map's axes
    bool in_next = false;
  };
  struct Voxels {
    LocalVoxelMap planes;
    LineVoxels lines;

    void add(const KeyFrame& frame);
    void clear();
    std::size_t bytes() const { return planes.bytes() + lines.bytes(); }
  };

  static KeyFrame keyFrameOf(std::span<const PlacedPoint> planes,
                             std::span<const PlacedPoint> edges);
  static Voxels emptyVoxels(const KeyFrameLimits& limits);
  void fillNext();
  void takeNext();

  KeyFrameLimits limits_;
  std::size_t kept_;             // key frames that are left
  std::deque<KeyFrame> frames_;  // oldest first
  bool has_first_ = false;       // the oldest is the first since clear()
  std::size_t next_frame_ = 0;   // of these: the next one that is to go into `next_`, if it may
  std::size_t filled_ = 0;
  Voxels now_, next_;
};

}  // namespace paloc
