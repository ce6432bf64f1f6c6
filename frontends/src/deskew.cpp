#include "paloc/frontends/deskew.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace paloc {
namespace {

// Four floats in one register, of which three are used: part of plain x86-64, and of others by the
// compiler's own means.
using Vec4f = float __attribute__((vector_size(16)));

/// A transform by its columns, p = x X + y Y + z Z + t.
struct Columns {
  Vec4f x, y, z, t;

  Vec4f apply(const Point3f& p) const { return p.x * x + (p.y * y + (p.z * z + t)); }
};

Columns columnsOf(const Pose& pose) {
  const auto column = [](const Vec3& v) {
    return Vec4f{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()),
                 0};
  };
  return {column(pose.rotation.col(0)), column(pose.rotation.col(1)), column(pose.rotation.col(2)),
          column(pose.position)};
}

/// T_end_lidar at the start of a slot, and its change until the end of the slot.
struct Slot {
  Columns at, change;
};

constexpr double kLongestSlot = 1e-3;   // s
constexpr double kShortestSlot = 5e-5;  // s
constexpr double kTolerance = 5e-5;     // m

// Taking a rotation at rate w as linear over dt displaces a point at range r by r (w dt)^2 / 8; an
// acceleration of 100 m/s2 displaces it by 0.0125 mm in a slot of 1 ms.
std::size_t slotCount(const ScanMotion& motion, double duration_s, double max_range_m) {
  const double rate = motion.maxRate();
  double slot_s = kLongestSlot;
  if (rate > 0) slot_s = std::min(slot_s, std::sqrt(8 * kTolerance / max_range_m) / rate);
  slot_s = std::max(slot_s, kShortestSlot);
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(duration_s / slot_s)));
}

std::vector<Slot> sampleMotion(const LidarFrame& frame, const ScanMotion& motion,
                               std::size_t count) {
  std::vector<Slot> slots(count);
  const auto at = [&](std::size_t i) {
    const TimeNs dt = frame.duration_ns * static_cast<TimeNs>(i) / static_cast<TimeNs>(count);
    return columnsOf(motion.bodyAt(frame.stamp_ns + dt) * frame.T_body_lidar);
  };
  Columns now = at(0);
  for (std::size_t i = 0; i < count; ++i) {
    const Columns next = at(i + 1);
    slots[i] = {now, {next.x - now.x, next.y - now.y, next.z - now.z, next.t - now.t}};
    now = next;
  }
  return slots;
}

struct Gate {
  float min_sq, max_sq;

  explicit Gate(RangeLimits limits)
      : min_sq(static_cast<float>(limits.min_m * limits.min_m)),
        max_sq(static_cast<float>(limits.max_m * limits.max_m)) {}
};

Scan emptyScanOf(const LidarFrame& frame) {
  Scan scan;
  scan.start_ns = frame.stamp_ns;
  scan.end_ns = frame.endNs();
  scan.sensor_position_body = frame.T_body_lidar.position;
  scan.points_body.resize(frame.points_lidar.size() + 1);  // moveInRange writes four floats a point
  return scan;
}

/// Moves all points within range by `move(index, point)`, packed one behind the other, and calls
/// `keep(index, place)` with the place of each, which holds if the point is within range. No branch
/// depends on the data: which points are out of range cannot be foreseen.
template <typename Move, typename Keep>
void moveInRange(const LidarFrame& frame, Gate gate, Scan& scan, DroppedPoints& dropped,
                 const Move& move, const Keep& keep) {
  const std::size_t n = frame.points_lidar.size();
  const Point3f* points = frame.points_lidar.data();
  Point3f* out = scan.points_body.data();
  std::size_t kept = 0, near = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point3f p = points[i];
    const float range_sq = p.x * p.x + p.y * p.y + p.z * p.z;
    const Vec4f moved = move(i, p);
    std::memcpy(static_cast<void*>(out + kept), &moved, sizeof moved);
    keep(i, kept);
    const bool is_near = range_sq < gate.min_sq;
    near += is_near;
    kept += !is_near & (range_sq <= gate.max_sq);
  }
  scan.points_body.resize(kept);
  dropped.too_near += near;
  dropped.too_far += n - kept - near;
}

}  // namespace

Scan deskew(const LidarFrame& frame, const ScanMotion& motion, RangeLimits limits,
            DroppedPoints& dropped) {
  if (frame.duration_ns <= 0 || frame.dt_ns.size() != frame.points_lidar.size()) {
    return placeOnBody(frame, limits, dropped);
  }
  Scan scan = emptyScanOf(frame);
  const double duration_s = static_cast<double>(frame.duration_ns) * 1e-9;
  const std::size_t count = slotCount(motion, duration_s, limits.max_m);
  const std::vector<Slot> slots = sampleMotion(frame, motion, count);
  const std::uint32_t* dt_ns = frame.dt_ns.data();
  const auto slots_per_ns =
      static_cast<float>(static_cast<double>(count) / static_cast<double>(frame.duration_ns));
  const auto last = static_cast<std::int32_t>(count - 1);
  scan.ages_s.resize(frame.points_lidar.size() + 1);
  float* ages_s = scan.ages_s.data();
  const auto duration = static_cast<float>(duration_s);
  moveInRange(
      frame, Gate(limits), scan, dropped,
      [&](std::size_t i, const Point3f& p) {
        const float place = static_cast<float>(dt_ns[i]) * slots_per_ns;
        const auto slot = std::min(static_cast<std::int32_t>(place), last);
        const float ratio = std::min(place - static_cast<float>(slot), 1.0F);
        const Slot& s = slots[static_cast<std::size_t>(slot)];
        return s.at.apply(p) + ratio * s.change.apply(p);
      },
      [&](std::size_t i, std::size_t at) {
        ages_s[at] = duration - 1e-9F * static_cast<float>(dt_ns[i]);
      });
  scan.ages_s.resize(scan.points_body.size());
  return scan;
}

Scan placeOnBody(const LidarFrame& frame, RangeLimits limits, DroppedPoints& dropped) {
  Scan scan = emptyScanOf(frame);
  const Columns T_body_lidar = columnsOf(frame.T_body_lidar);
  moveInRange(
      frame, Gate(limits), scan, dropped,
      [&](std::size_t, const Point3f& p) { return T_body_lidar.apply(p); },
      [](std::size_t, std::size_t) {});
  return scan;
}

}  // namespace paloc
