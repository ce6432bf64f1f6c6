#include "paloc/frontends/key_frame_map.h"

#include <limits>
#include <utility>

namespace paloc {
namespace {

constexpr std::size_t kPortion = 3;  // key frames that go into the next voxels with one: see kept_

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

// A quarter and one more key frames come while the next voxels are filled with three quarters:
// kPortion times as many.
KeyFrameMap::KeyFrameMap(const KeyFrameLimits& limits)
    : limits_(limits),
      kept_(limits.max_key_frames - limits.max_key_frames / 4),
      now_(emptyVoxels(limits)),
      next_(emptyVoxels(limits)) {}

KeyFrameMap::Voxels KeyFrameMap::emptyVoxels(const KeyFrameLimits& limits) {
  return {LocalVoxelMap(unlimited(limits)), LineVoxels(limits.line_voxel_m)};
}

void KeyFrameMap::Voxels::add(const KeyFrame& frame) {
  for (const Point3f& p : frame.planes) {
    const Vec3 ray = toDouble(p);
    planes.add(frame.sensor + ray, ray);
  }
  for (const Point3f& p : frame.edges) lines.add(frame.sensor + toDouble(p));
}

void KeyFrameMap::Voxels::clear() {
  planes.clear();
  lines.clear();
}

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
  if (frames_.empty()) has_first_ = true;
  frames_.push_back(keyFrameOf(planes, edges));
  now_.add(frames_.back());
  filled_ = 1;
  if (frames_.size() > kept_) fillNext();
  if (frames_.size() > limits_.max_key_frames) takeNext();
}

void KeyFrameMap::replaceFirst(std::span<const PlacedPoint> planes,
                               std::span<const PlacedPoint> edges) {
  if (!has_first_) return;
  KeyFrame first = keyFrameOf(planes, edges);
  first.in_next = frames_.front().in_next;
  frames_.front() = std::move(first);
  now_.clear();
  next_.clear();
  for (const KeyFrame& frame : frames_) {
    now_.add(frame);
    if (frame.in_next) next_.add(frame);
  }
}

void KeyFrameMap::fillNext() {
  if (frames_.size() == kept_ + 1) next_frame_ = limits_.max_key_frames + 1 - kept_;
  for (std::size_t i = 0; i < kPortion && next_frame_ < frames_.size(); ++i) {
    KeyFrame& frame = frames_[next_frame_++];
    frame.in_next = (frame.sensor - frames_.back().sensor).norm() <= limits_.max_distance_m;
    if (!frame.in_next) continue;
    next_.add(frame);
    ++filled_;
  }
}

void KeyFrameMap::takeNext() {
  has_first_ = has_first_ && frames_.front().in_next;
  std::erase_if(frames_, [](const KeyFrame& frame) { return !frame.in_next; });
  for (KeyFrame& frame : frames_) frame.in_next = false;
  std::swap(now_, next_);
  next_.clear();
}

void KeyFrameMap::clear() {
  has_first_ = false;
  frames_.clear();
  now_.clear();
  next_.clear();
}

std::size_t KeyFrameMap::bytes() const {
  std::size_t sum = now_.bytes() + next_.bytes();
  for (const KeyFrame& frame : frames_) {
    sum += sizeof(KeyFrame) + (frame.planes.capacity() + frame.edges.capacity()) * sizeof(Point3f);
  }
  return sum;
}

}  // namespace paloc
