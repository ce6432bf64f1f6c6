#include "paloc/map/map_changes.h"

#include <algorithm>
#include <numeric>

#include "change_candidates.h"
#include "map_coverage.h"
#include "parallel_chunks.h"
#include "ray_targets.h"
#include "ray_votes.h"

namespace paloc {
namespace {

constexpr double kTogether_m = 0.15;  // points of one object are nearer to each other

void append(MapChanges& changes, const Point3f& point, MapChange kind) {
  changes.cloud.points.push_back(point);
  changes.kinds.push_back(kind);
}

std::vector<RayTarget> targetsOf(const PriorMap& map, const ChangeCandidates& within) {
  std::vector<RayTarget> targets;
  for (std::uint32_t i = 0; i < map.size(); ++i) {
    RayTarget target{map.point(i)};
    const Vec3 p = target.position();
    if ((p.array() < within.low.array()).any() || (p.array() > within.high.array()).any()) continue;
    const MapPlane plane = map.plane(i);
    if (plane.planar()) {
      target.nx = plane.nx;
      target.ny = plane.ny;
      target.nz = plane.nz;
      target.offset_m = plane.offset_m;
    }
    targets.push_back(target);
  }
  return targets;
}

/// Of targets with their votes: which are seen through, by enough scans and far more than see them.
/// One in a plane that no ray came near to goes with those about it.
class SeenThrough {
 public:
  SeenThrough(const RayTargets& targets, const std::vector<RayVotes>& votes,
              const ChangeSettings& settings, int threads)
      : votes_(votes), sums_(sumAbout(targets, votes, threads)), settings_(settings) {}

  bool operator()(std::uint32_t i) const {
    const auto scans = static_cast<std::uint32_t>(settings_.min_scans);
    return dominates(votes_[i].passes, votes_[i].hits) && sums_[i].most_passes >= scans &&
           sums_[i].passes >= 3 * scans && dominates(sums_[i].passes, sums_[i].hits);
  }

 private:
  bool dominates(std::uint32_t passes, std::uint32_t hits) const {
    return static_cast<double>(passes) >= settings_.min_dominance * static_cast<double>(hits);
  }
  const std::vector<RayVotes>& votes_;
  std::vector<VoteSums> sums_;
  const ChangeSettings& settings_;
};

/// Groups of targets that hang together: the group of each, by its smallest member.
std::vector<std::uint32_t> groupsOf(const RayTargets& targets, const std::vector<bool>& taken) {
  std::vector<std::uint32_t> group(targets.size());
  std::iota(group.begin(), group.end(), 0U);
  const auto root = [&group](std::uint32_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  for (std::uint32_t i = 0; i < targets.size(); ++i) {
    if (!taken[i]) continue;
    targets.near(targets[i].position(), kTogether_m, [&](std::uint32_t other) {
      if (!taken[other]) return;
      const std::uint32_t a = root(i), b = root(other);
      group[std::max(a, b)] = std::min(a, b);
    });
  }
  for (std::uint32_t i = 0; i < targets.size(); ++i) group[i] = root(i);
  return group;
}

/// What became of the returns that the map does not explain.
class Unexplained {
 public:
  Unexplained(const PriorMap& map, const Vec3& up, RayTargets& targets,
              const std::vector<RayVotes>& votes, const ChangeSettings& settings, int threads)
      : targets_(targets), votes_(votes), settings_(settings), coverage_(map, up) {
    arena_.initialize(std::max(threads, 1));
  }

  void tell(const std::vector<VoteSums>& sums, MapChanges& changes) {
    std::vector<bool> moved(targets_.size()), stays(targets_.size());
    for (std::uint32_t i = 0; i < targets_.size(); ++i) {
      moved[i] = hasMoved(votes_[i], sums[i]);
      stays[i] = !moved[i] && isPersistent(votes_[i]);
    }
    for (std::uint32_t i = 0; i < targets_.size(); ++i) {
      if (moved[i]) append(changes, targets_[i].point, MapChange::kMoved);
    }
    tellStanding(stays, changes);
  }

 private:
  bool hasMoved(const RayVotes& votes, const VoteSums& sums) const {
    return votes.hits > 0 && votes.passes > 0 && sums.passes > sums.hits &&
           sums.most_passes >= static_cast<std::uint32_t>(settings_.min_scans);
  }
  bool isPersistent(const RayVotes& votes) const {
    return votes.hits >= settings_.min_scans &&
           votes.hits >= settings_.min_dominance * votes.passes &&
           secondsBetween(votes.first_hit_ns, votes.last_hit_ns) >= settings_.min_persistence_s;
  }

  struct Group {
    std::size_t points = 0, covered = 0;
  };

  void tellStanding(std::vector<bool>& stays, MapChanges& changes) {
    constexpr std::size_t kChunk = 256;
    std::vector<std::uint8_t> continues(targets_.size()), covered(targets_.size());
    forEachChunk(arena_, targets_.size(), kChunk,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) {
                     if (!stays[i]) continue;
                     const RayTarget& target = targets_[static_cast<std::uint32_t>(i)];
                     continues[i] = coverage_.continuesPlane(target);
                     covered[i] = coverage_.hasGroundBelow(target.position());
                   }
                 });
    std::vector<bool> apart(targets_.size());
    for (std::size_t i = 0; i < targets_.size(); ++i) apart[i] = stays[i] && continues[i] == 0;
    const std::vector<std::uint32_t> group_of = groupsOf(targets_, apart);
    std::vector<Group> groups(targets_.size());
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      if (!apart[i]) continue;
      ++groups[group_of[i]].points;
      groups[group_of[i]].covered += covered[i];
    }
    for (std::uint32_t i = 0; i < targets_.size(); ++i) {
      if (!stays[i]) continue;
      const Group& group = groups[group_of[i]];
      if (continues[i] != 0) {
        append(changes, targets_[i].point, MapChange::kUnmapped);
      } else if (group.points >= static_cast<std::size_t>(settings_.min_object_points)) {
        append(changes, targets_[i].point,
               2 * group.covered > group.points ? MapChange::kAdded : MapChange::kUnmapped);
      }
    }
  }

  RayTargets& targets_;
  const std::vector<RayVotes>& votes_;
  const ChangeSettings& settings_;
  MapCoverage coverage_;
  tbb::task_arena arena_;
};

}  // namespace

std::string toString(MapChange change) {
  switch (change) {
    case MapChange::kGone:
      return "gone";
    case MapChange::kAdded:
      return "added";
    case MapChange::kMoved:
      return "moved";
    case MapChange::kUnmapped:
      return "unmapped";
  }
  return "unknown";
}

std::size_t MapChanges::count(MapChange kind) const {
  return static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), kind));
}

MapChanges findChanges(const PriorMap& map, const ScanRaySource& scans, const Vec3& up_map,
                       const ChangeSettings& settings, const ChangeNoise& noise, int threads) {
  const ChangeMargins margins(settings, noise);
  ChangeCandidates candidates = gatherCandidates(map, scans, margins, threads);
  MapChanges changes;
  changes.cloud.origin = map.origin();
  changes.scans_used = candidates.scans_used;
  changes.scans_unsure = candidates.scans_unsure;
  {
    const RayTargets targets(targetsOf(map, candidates));
    const std::vector<RayVotes> votes = castVotes(targets, scans, margins, threads);
    const SeenThrough seen_through(targets, votes, settings, threads);
    for (std::uint32_t i = 0; i < targets.size(); ++i) {
      changes.map_points_seen += votes[i].passes + votes[i].hits > 0;
      if (seen_through(i)) append(changes, targets[i].point, MapChange::kGone);
    }
  }
  RayTargets targets(std::move(candidates.targets));
  fitPlanesTo(targets, threads);
  const std::vector<RayVotes> votes = castVotes(targets, scans, margins, threads);
  Unexplained(map, up_map, targets, votes, settings, threads)
      .tell(sumAbout(targets, votes, threads), changes);
  return changes;
}

}  // namespace paloc
