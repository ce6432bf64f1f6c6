#include "change_candidates.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "parallel_chunks.h"
#include "plane_fit.h"
#include "point_vector.h"
#include "voxel_key.h"

namespace paloc {
namespace {

constexpr std::size_t kBatch = 16;
constexpr double kVoxel_m = 0.05;
constexpr double kNearSurface_m = 0.15;  // a plane of the map reaches this far beyond its points
constexpr double kAbout_m = 0.15;
constexpr double kThickest_m = 0.03;

class Explainer {
 public:
  Explainer(const PriorMap& map, const ChangeMargins& margins) : map_(map), margins_(margins) {}

  /// The returns of a scan that no surface of the map is near to.
  std::vector<Point3f> unexplained(const ScanRays& scan) const {
    std::vector<Point3f> off;
    for (std::size_t i = 0; i < scan.to.size(); ++i) {
      const double range_m = (toVec(scan.to[i]) - toVec(scan.from[i])).norm();
      if (range_m <= margins_.settings().max_range_m && !isExplained(scan, scan.to[i], range_m)) {
        off.push_back(scan.to[i]);
      }
    }
    return off;
  }

 private:
  bool isExplained(const ScanRays& scan, const Point3f& p, double range_m) const {
    const double off_m = margins_.settings().clear_m + margins_.noise(scan, range_m, 1);
    const double reach_m = std::max(kNearSurface_m, off_m);
    const PriorMap::Nearest nearest = map_.nearest(p, static_cast<float>(reach_m));
    if (!nearest.found()) return false;
    const MapPlane plane = map_.plane(nearest.index);
    if (!plane.planar()) return std::sqrt(static_cast<double>(nearest.distance_sq)) < off_m;
    const Point3f& m = map_.point(nearest.index);
    const float off =
        plane.nx * (p.x - m.x) + plane.ny * (p.y - m.y) + plane.nz * (p.z - m.z) - plane.offset_m;
    return std::abs(static_cast<double>(off)) < off_m;
  }

  const PriorMap& map_;
  const ChangeMargins& margins_;
};

/// Means by voxel, in the order in which the voxels were first met.
class VoxelMeans {
 public:
  void add(const Point3f& p) {
    constexpr double kInverse = 1 / kVoxel_m;
    const std::uint64_t key = voxelIndex(p.x, kInverse) << (2 * kVoxelBits) |
                              voxelIndex(p.y, kInverse) << kVoxelBits | voxelIndex(p.z, kInverse);
    const auto [place, is_new] = index_.try_emplace(key, sums_.size());
    if (is_new) sums_.push_back({Vec3::Zero(), 0});
    Sum& sum = sums_[place->second];
    sum.of += toVec(p);
    ++sum.count;
  }
  std::vector<RayTarget> targets() const {
    std::vector<RayTarget> means;
    for (const Sum& sum : sums_) {
      const Eigen::Vector3f mean = (sum.of / sum.count).cast<float>();
      means.push_back({{mean.x(), mean.y(), mean.z()}});
    }
    return means;
  }

 private:
  struct Sum {
    Vec3 of;
    int count;
  };
  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::vector<Sum> sums_;
};

void widen(ChangeCandidates& box, const std::vector<Point3f>& points) {
  for (const Point3f& p : points) {
    box.low = box.low.cwiseMin(toVec(p));
    box.high = box.high.cwiseMax(toVec(p));
  }
}

}  // namespace

ChangeCandidates gatherCandidates(const PriorMap& map, const ScanRaySource& scans,
                                  const ChangeMargins& margins, int threads) {
  ChangeCandidates found;
  found.low.setConstant(1e9);
  found.high.setConstant(-1e9);
  VoxelMeans means;
  const Explainer explainer(map, margins);
  tbb::task_arena arena(std::max(threads, 1));
  struct OneScan {
    ScanRays rays;
    std::vector<Point3f> off;
  };
  for (std::size_t first = 0; first < scans.size(); first += kBatch) {
    std::vector<OneScan> batch(std::min(kBatch, scans.size() - first));
    forEachChunk(arena, batch.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      batch[i].rays = scans.rays(first + i);
      if (margins.usable(batch[i].rays)) batch[i].off = explainer.unexplained(batch[i].rays);
    });
    for (const OneScan& scan : batch) {
      if (!margins.usable(scan.rays)) {
        ++found.scans_unsure;
        continue;
      }
      ++found.scans_used;
      widen(found, scan.rays.from);
      widen(found, scan.rays.to);
      for (const Point3f& p : scan.off) means.add(p);
    }
  }
  found.targets = means.targets();
  return found;
}

void fitPlanesTo(RayTargets& targets, int threads) {
  constexpr std::size_t kChunk = 4096;
  PlaneFitLimits limits;
  limits.max_thickness_m = kThickest_m;
  limits.clean_thickness_m = kThickest_m;  // the voxels' means are noisy: no search for two faces
  std::vector<MapPlane> planes(targets.size());
  tbb::task_arena arena(std::max(threads, 1));
  forEachChunk(arena, targets.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    NearPoints about;
    PlaneFit fit(limits);
    for (std::size_t i = begin; i < end; ++i) {
      const Point3f& p = targets[static_cast<std::uint32_t>(i)].point;
      about.clear();
      targets.near(toVec(p), kAbout_m, [&](std::uint32_t other) {
        const Point3f& q = targets[other].point;
        about.add(q.x - p.x, q.y - p.y, q.z - p.z);
      });
      about.close();
      planes[i] = fit(about, static_cast<float>(kAbout_m * kAbout_m));
    }
  });
  for (std::size_t i = 0; i < planes.size(); ++i) {
    targets.setPlane(static_cast<std::uint32_t>(i), planes[i]);
  }
}

}  // namespace paloc
