#include "paloc/frontends/key_frame_map.h"

#include <limits>
#include <utility>

namespace paloc {
namespace {

// The key frames bound the number of voxels already.
LocalMapSettings unlimited(const KeyFrameLimits& limits) {
  LocalMapSettings result;
  result.voxel_m = limits.voxel_m;
  result.level_factor = limits.level_factor;
  result.levels = limits.levels;
  result.max_voxels = std::numeric_limits<int>::max();
  return result;
}

Point3f toFloat(const Vec3& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

Vec3 toDouble(const Point3f& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

}  // namespace

KeyFrameMap::KeyFrameMap(const KeyFrameLimits& limits)
    : limits_(limits), planes_(unlimited(limits)), lines_(limits.line_voxel_m) {}

// A point's ray begins at the sensor, which is taken to be at one place for the whole scan.
KeyFrameMap::KeyFrame KeyFrameMap::keyFrameOf(std::span<const PlacedPoint> planes,
                                              std::span<const PlacedPoint> edges) {
  KeyFrame frame;
  if (!planes.empty()) frame.sensor = planes.back().point_odom - planes.back().ray;
  for (const PlacedPoint& p : planes) frame.planes.push_back(toFloat(p.point_odom - frame.sensor));
  for (const PlacedPoint& p : edges) frame.edges.push_back(toFloat(p.point_odom - frame.sensor));
  return frame;
}

void KeyFrameMap::add(std::span<const PlacedPoint> planes, std::span<const PlacedPoint> edges) {
  frames_.push_back(keyFrameOf(planes, edges));
  if (frames_.size() > limits_.max_key_frames) {
    forget();
    refill();
  } else {
    fill(frames_.back());
  }
}

void KeyFrameMap::replaceFirst(std::span<const PlacedPoint> planes,
                               std::span<const PlacedPoint> edges) {
  if (frames_.empty()) return;
  frames_.front() = keyFrameOf(planes, edges);
  refill();
}

void KeyFrameMap::fill(const KeyFrame& frame) {
  for (const Point3f& p : frame.planes) {
    const Vec3 ray = toDouble(p);
    planes_.add(frame.sensor + ray, ray);
  }
  for (const Point3f& p : frame.edges) lines_.add(frame.sensor + toDouble(p));
}

void KeyFrameMap::refill() {
  planes_.clear();
  lines_.clear();
  for (const KeyFrame& frame : frames_) fill(frame);
}

void KeyFrameMap::forget() {
  const Vec3 here = frames_.back().sensor;
  std::erase_if(frames_, [&](const KeyFrame& frame) {
    return (frame.sensor - here).norm() > limits_.max_distance_m;
  });
  const std::size_t kept = limits_.max_key_frames - limits_.max_key_frames / 4;
  while (frames_.size() > kept) frames_.pop_front();
}

void KeyFrameMap::clear() {
  frames_.clear();
  planes_.clear();
  lines_.clear();
}

std::size_t KeyFrameMap::bytes() const {
  std::size_t sum = planes_.bytes() + lines_.bytes();
  for (const KeyFrame& frame : frames_) {
    sum += sizeof(KeyFrame) + (frame.planes.capacity() + frame.edges.capacity()) * sizeof(Point3f);
  }
  return sum;
}

}  // namespace paloc
