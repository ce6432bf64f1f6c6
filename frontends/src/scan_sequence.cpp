#include "scan_sequence.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "paloc/map/voxel_filter.h"
#include "plane_grid.h"

namespace paloc {
namespace {

constexpr std::size_t kMostPoints = 5000;
constexpr std::size_t kFewestPoints = 200;
constexpr double kLongestStep = 0.35;  // s from scan to scan

using Plain6 = Eigen::Matrix<double, 6, 1>;
using Plain66 = Eigen::Matrix<double, 6, 6>;

struct System {
  Plain66 h = Plain66::Zero();
  Plain6 g = Plain6::Zero();
  std::size_t used = 0;
};

System linearize(PlaneGrid& planes, const std::vector<Vec3>& points, const Pose& T,
                 double scale_m) {
  System system;
  for (std::size_t i = 0; i < points.size(); i += 2) {
    const Vec3 p = T * points[i];
    const auto plane = planes.at(p);
    if (!plane) continue;
    const double r = plane->normal.dot(p - plane->point);
    if (std::abs(r) > 3 * scale_m) continue;
    const double weight = 1 / (1 + r * r / (scale_m * scale_m));  // Cauchy
    Plain6 j;
    j.head<3>() = plane->normal;
    j.tail<3>() = points[i].cross(T.rotation.transpose() * plane->normal);
    system.h += weight * j * j.transpose();
    system.g -= weight * r * j;
    ++system.used;
  }
  return system;
}

/// Moves T to where the points lie on the planes. False if too few do, or they fix too little.
bool registerTo(PlaneGrid& planes, const std::vector<Vec3>& points, Pose& T) {
  constexpr double kScales[] = {0.3, 0.15, 0.1, 0.06, 0.06, 0.06};  // m
  constexpr std::size_t kFewestUsed = 100;
  for (const double scale_m : kScales) {
    System system = linearize(planes, points, T, scale_m);
    if (system.used < kFewestUsed) return false;
    // Where nothing fixes a direction (along a corridor) the prediction stays.
    system.h.diagonal().array() += 1.0;
    const Plain6 delta = system.h.ldlt().solve(system.g);
    if (!delta.allFinite() || delta.norm() > 1) return false;
    T = boxplus(T, Vec6(delta));
  }
  T.rotation = so3::normalized(T.rotation);
  return true;
}

double ageS(const LidarFrame& frame, std::size_t i) {
  return frame.dt_ns.empty() ? 0 : 1e-9 * static_cast<double>(frame.duration_ns - frame.dt_ns[i]);
}

// As dense as the most points allow.
std::vector<std::uint32_t> thinned(const std::vector<Point3f>& points) {
  VoxelFilter filter;
  for (double voxel_m = 0.1;; voxel_m *= 1.5) {
    std::vector<std::uint32_t> kept = filter.select(points, voxel_m);
    if (kept.size() <= kMostPoints) return kept;
  }
}

}  // namespace

bool ScanSequence::add(const LidarFrame& frame) {
  if (scans_.size() == kMostScans || frame.points_lidar.size() < kFewestPoints) return false;
  if (!scans_.empty()) {
    const double step_s = secondsBetween(scans_.back().end_ns, frame.endNs());
    if (!(step_s > 0.01 && step_s < kLongestStep)) return false;
  }
  ThinScan scan{frame.stamp_ns, frame.endNs(), {}};
  for (const std::uint32_t i : thinned(frame.points_lidar)) {
    scan.points.push_back({frame.points_lidar[i], static_cast<float>(ageS(frame, i))});
  }
  scans_.push_back(std::move(scan));
  return true;
}

// A tenth of the usual range: small in a room, large in the open.
double ScanSequence::voxelSize() const {
  std::vector<double> ranges;
  for (const TimedPoint& point : scans_.front().points) {
    ranges.push_back(Vec3(point.p.x, point.p.y, point.p.z).norm());
  }
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return std::clamp(0.12 * *middle, 0.4, 2.0);
}

std::vector<Vec3> ScanSequence::movedEvenly(const ThinScan& scan, const Pose& T_before_now,
                                            double dt_s) const {
  const Vec3 turn = so3::log(T_before_now.rotation) / dt_s;
  const Vec3 velocity = T_before_now.rotation.transpose() * T_before_now.position / dt_s;
  std::vector<Vec3> points;
  points.reserve(scan.points.size());
  for (const TimedPoint& point : scan.points) {
    const double age = static_cast<double>(point.age_s);
    points.push_back(so3::exp(-age * turn) * Vec3(point.p.x, point.p.y, point.p.z) -
                     age * velocity);
  }
  return points;
}

bool ScanSequence::track() {
  if (scans_.size() < 2) return false;
  PlaneGrid planes(voxelSize());
  by_gyro_ = false;
  poses_.assign(1, Pose{});
  registered_.assign(1, true);
  Pose step;  // T_before_now, as far as known
  std::size_t good = 0;
  for (const Vec3& p : movedEvenly(scans_[0], step, 1)) planes.add(p);
  for (std::size_t i = 1; i < scans_.size(); ++i) {
    const double dt_s = secondsBetween(scans_[i - 1].end_ns, scans_[i].end_ns);
    Pose T = poses_.back() * step;
    std::vector<Vec3> points;
    bool found = false;
    for (int round = 0; round < 3; ++round) {  // how it is moved depends on what is found
      points = movedEvenly(scans_[i], poses_.back().inverse() * T, dt_s);
      found = registerTo(planes, points, T);
      if (!found) break;
    }
    if (!found) T = poses_.back() * step;
    step = poses_.back().inverse() * T;
    poses_.push_back(T);
    registered_.push_back(found);
    good += found;
    if (!found) continue;
    for (const Vec3& p : points) planes.add(T * p);
  }
  return good > scans_.size() / 2;
}

// In the LiDAR's frame at the scan's end (m/s).
Vec3 ScanSequence::velocityAt(std::size_t i) const {
  const std::size_t to = std::max<std::size_t>(1, i);
  const double dt_s = secondsBetween(scans_[to - 1].end_ns, scans_[to].end_ns);
  return poses_[i].rotation.transpose() * (poses_[to].position - poses_[to - 1].position) / dt_s;
}

std::vector<Vec3> ScanSequence::movedWith(const ThinScan& scan, const Vec3& velocity,
                                          const Rotation& rotation) const {
  constexpr int kSlots = 32;
  const TimeNs length = scan.end_ns - scan.start_ns;
  std::vector<Vec3> turns(kSlots + 1);  // of the LiDAR at the slots' borders, seen from the end
  for (int k = 0; k <= kSlots; ++k) {
    turns[static_cast<std::size_t>(k)] =
        so3::log(rotation(scan.end_ns, scan.end_ns - length * k / kSlots));
  }
  std::vector<Vec3> points;
  points.reserve(scan.points.size());
  const double slots_per_s = length > 0 ? kSlots / secondsBetween(0, length) : 0;
  for (const TimedPoint& point : scan.points) {
    const double age = static_cast<double>(point.age_s);
    const double slot = std::clamp(age * slots_per_s, 0.0, kSlots - 1e-6);
    const auto k = static_cast<std::size_t>(slot);
    const double part = slot - static_cast<double>(k);
    const Vec3 turn = (1 - part) * turns[k] + part * turns[k + 1];
    points.push_back(so3::exp(turn) * Vec3(point.p.x, point.p.y, point.p.z) - age * velocity);
  }
  return points;
}

void ScanSequence::trackWith(const Rotation& rotation) {
  const std::vector<Pose> before = poses_;
  std::vector<Vec3> velocities;
  for (std::size_t i = 0; i < scans_.size(); ++i) velocities.push_back(velocityAt(i));
  PlaneGrid planes(voxelSize());
  by_gyro_ = true;
  for (const Vec3& p : movedWith(scans_[0], velocities[0], rotation)) planes.add(p);
  for (std::size_t i = 1; i < scans_.size(); ++i) {
    const std::vector<Vec3> points = movedWith(scans_[i], velocities[i], rotation);
    const Pose step = before[i - 1].inverse() * before[i];
    Pose T = poses_[i - 1] * step;
    registered_[i] = registerTo(planes, points, T);
    poses_[i] = registered_[i] ? T : poses_[i - 1] * step;
    if (!registered_[i]) continue;
    for (const Vec3& p : points) planes.add(poses_[i] * p);
  }
}

void ScanSequence::appendSteps(std::vector<TurnStep>& steps) const {
  // Moved to the middle of its time, an evenly moved scan is a mean over that time.
  const auto middle = [this](std::size_t i) {
    const Pose step = poses_[i - 1].inverse() * poses_[i];
    const double share = 0.5 * static_cast<double>(scans_[i].end_ns - scans_[i].start_ns) /
                         static_cast<double>(scans_[i].end_ns - scans_[i - 1].end_ns);
    return Mat3(poses_[i].rotation * so3::exp(-share * so3::log(step.rotation)));
  };
  for (std::size_t i = by_gyro_ ? 1 : 2; i < poses_.size(); ++i) {
    if (!registered_[i] || !registered_[i - 1]) continue;
    TurnStep step;
    step.from_ns = scans_[i - 1].end_ns;
    step.to_ns = scans_[i].end_ns;
    step.window_ns = scans_[i].end_ns - scans_[i].start_ns;
    step.moved_by_gyro = by_gyro_;
    const Mat3 R_from = by_gyro_ ? poses_[i - 1].rotation : middle(i - 1);
    const Mat3 R_to = by_gyro_ ? poses_[i].rotation : middle(i);
    step.turn = so3::log(R_from.transpose() * R_to);
    steps.push_back(step);
  }
}

}  // namespace paloc
