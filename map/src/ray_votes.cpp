#include "ray_votes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel_chunks.h"
#include "point_vector.h"

namespace paloc {
namespace {

constexpr std::size_t kBatch = 16;  // scans whose votes are kept until they are counted
constexpr double kSigmas = 3;
constexpr double kAcross_m = 0.04;  // a ray that crosses a plane this near to a point crosses it
constexpr double kAcrossNoPlane_m = 0.02;  // the same where no plane tells where the surface is
constexpr double kSeenWithin_m = 0.08;     // a ray that ends this near to a point sees it
constexpr double kNear_m = 0.3;            // no target this near to the sensor
constexpr double kNoPlaneClear_m = 0.1;
constexpr double kAbout_m = 0.15;  // neighbours that vote together
constexpr double kSameNormal = 0.8;

double offPlane(const RayTarget& target, const Vec3& p) {
  return target.normal().dot(p - target.position()) - static_cast<double>(target.offset_m);
}

struct Ray {
  Vec3 from, to, direction;
  double range_m;
};

/// The votes of one scan.
class ScanVote {
 public:
  ScanVote(const RayTargets& targets, const ScanRays& scan, const ChangeMargins& margins)
      : targets_(targets), scan_(scan), margins_(margins) {
    for (std::size_t i = 0; i < scan.to.size(); ++i) {
      const Vec3 from = toVec(scan.from[i]), to = toVec(scan.to[i]);
      const double range_m = (to - from).norm();
      if (range_m < kNear_m) continue;
      cast({from, to, (to - from) / range_m, range_m});
    }
    unique(passed_);
    unique(seen_);
    std::vector<std::uint32_t> only;
    std::set_difference(passed_.begin(), passed_.end(), seen_.begin(), seen_.end(),
                        std::back_inserter(only));
    passed_.swap(only);
  }
  const std::vector<std::uint32_t>& passed() const { return passed_; }  // and not seen
  const std::vector<std::uint32_t>& seen() const { return seen_; }

 private:
  static void unique(std::vector<std::uint32_t>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  void cast(const Ray& ray) {
    const double reach_m = std::min(ray.range_m, margins_.settings().max_range_m);
    targets_.along(ray.from + kNear_m * ray.direction, ray.from + reach_m * ray.direction,
                   [&](std::uint32_t index) {
                     if (passes(ray, targets_[index])) passed_.push_back(index);
                   });
    if (ray.range_m > margins_.settings().max_range_m) return;
    targets_.near(ray.to, kSeenWithin_m, [&](std::uint32_t index) {
      if (sees(ray, targets_[index])) seen_.push_back(index);
    });
  }

  bool passes(const Ray& ray, const RayTarget& target) const {
    const Vec3 to_target = target.position() - ray.from;
    const double clear_m = margins_.settings().clear_m;
    if (!target.planar()) {
      const double along_m = to_target.dot(ray.direction);
      return (to_target - along_m * ray.direction).norm() < kAcrossNoPlane_m &&
             ray.range_m - along_m > kNoPlaneClear_m + clear_m + margins_.noise(scan_, along_m, 1);
    }
    const double cosine = target.normal().dot(ray.direction);
    if (std::abs(cosine) < margins_.settings().min_incidence_cos) return false;
    const double along_m =
        (target.normal().dot(to_target) + static_cast<double>(target.offset_m)) / cosine;
    return (to_target - along_m * ray.direction).norm() < kAcross_m &&
           (ray.range_m - along_m) * std::abs(cosine) >
               clear_m + margins_.noise(scan_, along_m, cosine);
  }

  bool sees(const Ray& ray, const RayTarget& target) const {
    if (!target.planar()) return true;
    const double cosine = target.normal().dot(ray.direction);
    return std::abs(offPlane(target, ray.to)) < margins_.noise(scan_, ray.range_m, cosine);
  }

  const RayTargets& targets_;
  const ScanRays& scan_;
  const ChangeMargins& margins_;
  std::vector<std::uint32_t> passed_, seen_;
};

void count(std::uint16_t& counter) {
  if (counter < std::numeric_limits<std::uint16_t>::max()) ++counter;
}

void countSeen(RayVotes& votes, TimeNs t_ns) {
  if (votes.hits == 0) votes.first_hit_ns = t_ns;
  votes.last_hit_ns = t_ns;
  count(votes.hits);
}

}  // namespace

double ChangeMargins::noise(const ScanRays& scan, double range_m, double cosine) const {
  const double range = noise_.range_m * cosine, turned = scan.rotation_sigma_rad * range_m;
  return kSigmas * std::sqrt(range * range + noise_.map_m * noise_.map_m +
                             scan.position_sigma_m * scan.position_sigma_m + turned * turned);
}

std::vector<RayVotes> castVotes(const RayTargets& targets, const ScanRaySource& scans,
                                const ChangeMargins& margins, int threads) {
  std::vector<RayVotes> votes(targets.size());
  if (votes.empty()) return votes;
  tbb::task_arena arena(std::max(threads, 1));
  struct OneScan {
    TimeNs t_ns = 0;
    std::vector<std::uint32_t> passed, seen;
  };
  for (std::size_t first = 0; first < scans.size(); first += kBatch) {
    std::vector<OneScan> batch(std::min(kBatch, scans.size() - first));
    forEachChunk(arena, batch.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      const ScanRays rays = scans.rays(first + i);
      if (!margins.usable(rays)) return;
      const ScanVote vote(targets, rays, margins);
      batch[i] = {rays.t_ns, vote.passed(), vote.seen()};
    });
    for (const OneScan& scan : batch) {
      for (const std::uint32_t index : scan.passed) count(votes[index].passes);
      for (const std::uint32_t index : scan.seen) countSeen(votes[index], scan.t_ns);
    }
  }
  return votes;
}

std::vector<VoteSums> sumAbout(const RayTargets& targets, const std::vector<RayVotes>& votes,
                               int threads) {
  constexpr std::size_t kChunk = 4096;
  std::vector<VoteSums> sums(targets.size());
  tbb::task_arena arena(std::max(threads, 1));
  forEachChunk(arena, targets.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const RayTarget& target = targets[static_cast<std::uint32_t>(i)];
      if (votes[i].passes == 0 && (votes[i].hits > 0 || !target.planar())) continue;
      targets.near(target.position(), kAbout_m, [&](std::uint32_t other) {
        const RayTarget& neighbour = targets[other];
        if (target.planar() && neighbour.planar() &&
            std::abs(target.normal().dot(neighbour.normal())) < kSameNormal) {
          return;
        }
        sums[i].passes += votes[other].passes;
        sums[i].hits += votes[other].hits;
        sums[i].most_passes = std::max<std::uint32_t>(sums[i].most_passes, votes[other].passes);
      });
    }
  });
  return sums;
}

}  // namespace paloc
