#include "paloc/frontends/ring_features.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace paloc {
namespace {

constexpr std::size_t kLeastReach = 3, kMostReach = 64;  // points to each side of a window
constexpr std::size_t kSectors = 6;
constexpr std::size_t kAngleSamples = 64;
constexpr double kGapSteps = 3;       // between returns, in the usual angle: others are missing
constexpr double kJump_m = 0.1;       // of the range between neighbours, beyond what a slope makes,
constexpr double kMostSlope = 6;      // which is so many times the way across
constexpr double kAlongBeam = 0.966;  // cosine of 15 degrees
constexpr double kEdgeNoise = 3, kPlaneNoise = 2;  // bends from noise, in standard deviations
constexpr float kSilhouetteBend = 2;  // before all others: a jump is the clearest of edges

}  // namespace

Vec3 RingFeatures::point(std::size_t at) const {
  const Point3f& p = points_[at];
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

Vec3 RingFeatures::meanOf(std::size_t begin, std::size_t end) const {
  const Total &a = total_[begin], &b = total_[end];
  return Vec3(b.x - a.x, b.y - a.y, b.z - a.z) / static_cast<double>(end - begin);
}

void RingFeatures::extract(const LidarFrame& frame) {
  edges_.clear();
  planes_.clear();
  sortByRing(frame);
  for (std::size_t ring = 0; ring + 1 < ring_begin_.size(); ++ring) {
    extractRing(ring_begin_[ring], ring_begin_[ring + 1]);
  }
}

// By counting, which keeps the order within each ring; and what is needed of each point.
void RingFeatures::sortByRing(const LidarFrame& frame) {
  const std::size_t n = frame.ring.size();
  const std::size_t rings =
      n == 0 ? 0 : std::size_t{*std::max_element(frame.ring.begin(), frame.ring.end())} + 1;
  ring_begin_.assign(rings + 1, 0);
  for (const std::uint16_t ring : frame.ring) ++ring_begin_[ring + std::size_t{1}];
  std::partial_sum(ring_begin_.begin(), ring_begin_.end(), ring_begin_.begin());
  order_.resize(n);
  std::vector<std::uint32_t> next = ring_begin_;
  for (std::uint32_t i = 0; i < n; ++i) order_[next[frame.ring[i]]++] = i;
  points_.resize(n);
  range_.resize(n);
  total_.resize(n + 1);
  total_[0] = {};
  for (std::size_t at = 0; at < n; ++at) {
    const Point3f p = frame.points_lidar[order_[at]];
    points_[at] = p;
    range_[at] = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    const Total& t = total_[at];
    total_[at + 1] = {t.x + static_cast<double>(p.x), t.y + static_cast<double>(p.y),
                      t.z + static_cast<double>(p.z)};
  }
  link_.resize(n);
  run_begin_.resize(n);
  run_end_.resize(n);
  reach_.assign(n, 0);
  taken_.assign(n, 0);
}

void RingFeatures::extractRing(std::size_t begin, std::size_t end) {
  if (end - begin < 2 * kLeastReach + 1) return;
  candidates_.clear();
  linkPoints(begin, end);
  findRuns(begin, end);
  const double step_rad = stepAngle(begin, end);
  for (std::size_t at = begin; at < end; ++at) classify(at, step_rad);
  pickEdges(begin, end);
}

// The usual angle between neighbours, from some of them.
double RingFeatures::stepAngle(std::size_t begin, std::size_t end) {
  std::vector<float> some;
  const std::size_t stride = std::max<std::size_t>(1, (end - begin) / kAngleSamples);
  for (std::size_t at = begin; at + 1 < end; at += stride) some.push_back(angles_[at - begin]);
  const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
  std::nth_element(some.begin(), middle, some.end());
  return static_cast<double>(*middle);
}

// How each point of a ring goes on to the next.
void RingFeatures::linkPoints(std::size_t begin, std::size_t end) {
  angles_.resize(end - begin);
  for (std::size_t at = begin; at + 1 < end; ++at) {
    const Point3f &a = points_[at], &b = points_[at + 1];
    const float dx = b.x - a.x, dy = b.y - a.y, dz = b.z - a.z;
    const float dr = range_[at + 1] - range_[at];
    // d^2 = dr^2 + 4 r r' sin^2(angle / 2)
    const float across_sq = std::max(dx * dx + dy * dy + dz * dz - dr * dr, 0.0F);
    angles_[at - begin] = std::sqrt(across_sq / (range_[at] * range_[at + 1]));
  }
  const auto gap = static_cast<float>(kGapSteps * stepAngle(begin, end));
  for (std::size_t at = begin; at + 1 < end; ++at) {
    const float dr = range_[at + 1] - range_[at];
    const float angle = angles_[at - begin];
    const float near = std::min(range_[at], range_[at + 1]);
    const float jump = static_cast<float>(kJump_m) + static_cast<float>(kMostSlope) * angle * near;
    if (angle > gap) {
      link_[at] = Link::kGap;
    } else if (std::abs(dr) > jump) {
      link_[at] = dr > 0 ? Link::kNearBefore : Link::kNearAfter;
    } else {
      link_[at] = Link::kJoined;
    }
  }
  link_[end - 1] = Link::kGap;
}

void RingFeatures::findRuns(std::size_t begin, std::size_t end) {
  std::size_t run = begin;
  for (std::size_t at = begin; at < end; ++at) {
    if (link_[at] == Link::kJoined) continue;
    for (std::size_t i = run; i <= at; ++i) {
      run_begin_[i] = static_cast<std::uint32_t>(run);
      run_end_[i] = static_cast<std::uint32_t>(at + 1);
    }
    run = at + 1;
  }
}

// Sorts a point into plane, edge or neither.
void RingFeatures::classify(std::size_t at, double step_rad) {
  const double range = static_cast<double>(range_[at]);
  const auto wanted = static_cast<std::size_t>(
      std::clamp(limits_.window_m / (range * step_rad + 1e-9), static_cast<double>(kLeastReach),
                 static_cast<double>(kMostReach)));
  const std::size_t before = at - run_begin_[at], after = run_end_[at] - 1 - at;
  const std::size_t reach = std::min({wanted, before, after});
  reach_[at] = static_cast<std::uint16_t>(std::max(wanted, kLeastReach));
  if (after == 0 && link_[at] == Link::kNearBefore && before >= kLeastReach) {
    return addSilhouette(at, at - std::min(before, wanted));
  }
  if (before == 0 && after >= kLeastReach && at > 0 && link_[at - 1] == Link::kNearAfter) {
    return addSilhouette(at, at + std::min(after, wanted));
  }
  if (reach < kLeastReach) return;
  const Vec3 p = point(at), first = point(at - reach), last = point(at + reach);
  const Vec3 chord = last - first;
  if (std::abs(chord.dot(p)) > kAlongBeam * chord.norm() * range) return;
  const double half = 0.5 * ((first - p).norm() + (last - p).norm());
  const double off = 2 * (meanOf(at - reach, at + reach + 1) - meanOf(at - 1, at + 2)).norm();
  // Of the mean of three points; that of the window has little noise.
  const double noise = 2 * limits_.range_noise_m / std::sqrt(3.0);
  if (off < limits_.plane_bend * half + kPlaneNoise * noise) {
    planes_.push_back(order_[at]);
    return;
  }
  // What a jump hides goes on behind it: where the far side ends is no edge.
  const std::size_t run_first = run_begin_[at], run_last = run_end_[at] - 1;
  const bool hidden_before =
      before < 2 * wanted && run_first > 0 && link_[run_first - 1] == Link::kNearBefore;
  const bool hidden_after = after < 2 * wanted && link_[run_last] == Link::kNearAfter;
  if (hidden_before || hidden_after || reach < wanted) return;
  if (off > limits_.edge_bend * half + kEdgeNoise * noise) {
    candidates_.push_back({static_cast<float>(off / half), static_cast<std::uint32_t>(at)});
  }
}

// The last point of the near side of a jump, whose surface goes on to `inward_end`.
void RingFeatures::addSilhouette(std::size_t at, std::size_t inward_end) {
  const Vec3 p = point(at), inward = point(inward_end) - p;
  if (std::abs(inward.dot(p)) > kAlongBeam * inward.norm() * p.norm()) return;
  candidates_.push_back({kSilhouetteBend, static_cast<std::uint32_t>(at)});
}

// The sharpest of each sector, apart from each other by a window.
void RingFeatures::pickEdges(std::size_t begin, std::size_t end) {
  const auto sectorOf = [&](const Candidate& c) {
    return kSectors * (c.at - begin) / (end - begin);
  };
  std::sort(candidates_.begin(), candidates_.end(), [&](const Candidate& a, const Candidate& b) {
    const std::size_t s = sectorOf(a), t = sectorOf(b);
    if (s != t) return s < t;
    return a.bend != b.bend ? a.bend > b.bend : a.at < b.at;
  });
  std::size_t sector = kSectors;
  int picked = 0;
  for (const Candidate& c : candidates_) {
    if (sectorOf(c) != sector) picked = 0;
    sector = sectorOf(c);
    if (picked >= limits_.edges_per_sector || taken_[c.at] != 0) continue;
    ++picked;
    edges_.push_back(order_[c.at]);
    const std::size_t reach = reach_[c.at];
    const std::size_t from = c.at - std::min<std::size_t>(reach, c.at - begin);
    std::fill(taken_.begin() + static_cast<std::ptrdiff_t>(from),
              taken_.begin() + static_cast<std::ptrdiff_t>(std::min(c.at + reach + 1, end)), 1);
  }
}

}  // namespace paloc
