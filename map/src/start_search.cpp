#include "paloc/map/start_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <queue>

#include "paloc/core/so3.h"
#include "parallel_chunks.h"

namespace paloc {
namespace {

constexpr double kApartM = 1.0, kApartRad = 10 * std::numbers::pi / 180;
// Poses with fewer hits than this share of the best one's lead nowhere. Where half of the true
// place is missing in the map, wrong ones have more hits than it, but no more than all.
constexpr double kWorthOfBest = 0.6;
constexpr double kMinYawStepRad = 0.5 * std::numbers::pi / 180,
                 kMaxYawStepRad = 4 * std::numbers::pi / 180;

/// A cube of 2^level positions along each axis, at one heading.
struct Node {
  int bound = 0;
  std::int32_t level = 0, yaw = 0;
  CellIndex at;
};

// The most promising first, of these the smallest cube; then any fixed order.
struct Later {
  bool operator()(const Node& a, const Node& b) const {
    if (a.bound != b.bound) return a.bound < b.bound;
    if (a.level != b.level) return a.level > b.level;
    if (a.yaw != b.yaw) return a.yaw > b.yaw;
    if (a.at.z != b.at.z) return a.at.z > b.at.z;
    if (a.at.y != b.at.y) return a.at.y > b.at.y;
    return a.at.x > b.at.x;
  }
};

/// One search: the points at each heading, and the cubes that are still to be looked into.
class Search {
 public:
  Search(const SearchMap& map, const SearchPoints& points, const SearchBox& box,
         const SearchLimits& limits)
      : map_(map),
        limits_(limits),
        arena_(std::max(limits.threads, 1)),
        uprights_(points.upright.size()) {
    low_ = cellOf(box.low);
    high_ = cellOf(box.high);
    needed_ = std::max(
        1, static_cast<int>(std::ceil(limits.min_share * static_cast<double>(points.size()))));
    turn(points, box);
  }

  StartCandidates run();

 private:
  CellIndex cellOf(const Vec3& position) const {
    const Vec3 cells = (position - map_.frame.low) / map_.frame.cell_m;
    return {static_cast<int>(std::floor(cells.x())), static_cast<int>(std::floor(cells.y())),
            static_cast<int>(std::floor(cells.z()))};
  }
  void turn(const SearchPoints& points, const SearchBox& box);
  int bound(const Node& node, std::uint64_t& lookups) const;
  void addRoots();
  void split(const Node& node);
  bool nearFound(const Node& node) const;
  double yawOf(int index) const { return yaw_first_ + index * yaw_step_; }

  const SearchMap& map_;
  const SearchLimits& limits_;
  tbb::task_arena arena_;
  CellIndex low_, high_;  // positions, both included
  double yaw_first_ = 0, yaw_step_ = 0;
  std::vector<std::vector<CellIndex>>
      turned_;            // cells of the points at each heading, from the body
  std::size_t uprights_;  // the first so many of them are upright
  int needed_ = 1;
  std::uint64_t lookups_ = 0;
  std::priority_queue<Node, std::vector<Node>, Later> queue_;
  StartCandidates answer_;
};

// Headings lie so close that the points at the scan's reach move by a cell from one to the next.
void Search::turn(const SearchPoints& points, const SearchBox& box) {
  const double cell = map_.frame.cell_m, range = box.yaw_high - box.yaw_low;
  const double step =
      std::clamp(cell / std::max(points.reach_m, cell), kMinYawStepRad, kMaxYawStepRad);
  const auto steps = std::max(1.0, std::ceil(range / step));
  yaw_step_ = range / steps;
  yaw_first_ = box.yaw_low + yaw_step_ / 2;
  turned_.resize(static_cast<std::size_t>(steps));
  forEachChunk(arena_, turned_.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    const Mat3 rotation = so3::exp(Vec3(0, 0, yawOf(static_cast<int>(k))));
    const auto add = [&](const Vec3& point) {
      const Vec3 cells = (rotation * point / cell).array() + 0.5;
      turned_[k].push_back({static_cast<int>(std::floor(cells.x())),
                            static_cast<int>(std::floor(cells.y())),
                            static_cast<int>(std::floor(cells.z()))});
    };
    for (const Vec3& point : points.upright) add(point);
    for (const Vec3& point : points.others) add(point);
  });
}

// The most hits that any position of the cube can have; less than needed where it cannot have
// enough.
int Search::bound(const Node& node, std::uint64_t& lookups) const {
  const std::vector<CellIndex>& cells = turned_[static_cast<std::size_t>(node.yaw)];
  int possible = static_cast<int>(cells.size());
  for (std::size_t i = 0; i < cells.size() && possible >= needed_; ++i) {
    const OccupancyPyramid& pyramid = i < uprights_ ? map_.upright : map_.all;
    ++lookups;
    possible -= pyramid.any(node.level, node.at.x + cells[i].x, node.at.y + cells[i].y,
                            node.at.z + cells[i].z)
                    ? 0
                    : 1;
  }
  return possible;
}

void Search::addRoots() {
  const int extent = std::max({high_.x - low_.x, high_.y - low_.y, high_.z - low_.z, 0}) + 1;
  int level = map_.all.levels() - 1;
  while (level > 0 && 1 << (level - 1) >= extent) --level;
  const int edge = 1 << level;
  std::vector<std::vector<Node>> roots(turned_.size());
  std::vector<std::uint64_t> lookups(turned_.size());
  forEachChunk(arena_, turned_.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    for (int z = low_.z; z <= high_.z; z += edge) {
      for (int y = low_.y; y <= high_.y; y += edge) {
        for (int x = low_.x; x <= high_.x; x += edge) {
          Node node{0, level, static_cast<std::int32_t>(k), {x, y, z}};
          node.bound = bound(node, lookups[k]);
          if (node.bound >= needed_) roots[k].push_back(node);
        }
      }
    }
  });
  std::vector<Node> all;
  for (const std::vector<Node>& some : roots) all.insert(all.end(), some.begin(), some.end());
  for (const std::uint64_t some : lookups) lookups_ += some;
  queue_ = std::priority_queue<Node, std::vector<Node>, Later>(Later{}, std::move(all));
}

void Search::split(const Node& node) {
  const int half = 1 << (node.level - 1);
  for (int child = 0; child < 8; ++child) {
    Node part = node;
    part.level = node.level - 1;
    part.at.x += (child & 1) * half;
    part.at.y += (child >> 1 & 1) * half;
    part.at.z += (child >> 2) * half;
    if (part.at.x > high_.x || part.at.y > high_.y || part.at.z > high_.z) continue;
    part.bound = bound(part, lookups_);
    if (part.bound >= needed_) queue_.push(part);
  }
}

// Whether the whole cube lies about a candidate that is found already.
bool Search::nearFound(const Node& node) const {
  const double half = 0.5 * ((1 << node.level) - 1);
  const Vec3 centre = map_.frame.centre(node.at) + map_.frame.cell_m * Vec3::Constant(half);
  return std::any_of(answer_.found.begin(), answer_.found.end(), [&](const auto& candidate) {
    const double turn = std::remainder(yawOf(node.yaw) - candidate.yaw, 2 * std::numbers::pi);
    const Vec3 furthest =
        (centre - candidate.position).cwiseAbs().array() + half * map_.frame.cell_m;
    return std::abs(turn) < kApartRad && furthest.norm() < kApartM;
  });
}

StartCandidates Search::run() {
  addRoots();
  const auto limit = static_cast<std::uint64_t>(1e6 * limits_.max_mlookups);
  while (!queue_.empty() && answer_.found.size() < limits_.candidates) {
    const Node node = queue_.top();
    queue_.pop();
    if (node.bound < needed_) break;  // so are all the others
    if (nearFound(node)) continue;
    if (lookups_ > limit) {
      answer_.finished = false;
      break;
    }
    if (node.level > 0) {
      split(node);
      continue;
    }
    answer_.found.push_back({map_.frame.centre(node.at), yawOf(node.yaw), node.bound});
    needed_ = std::max(needed_, static_cast<int>(kWorthOfBest * answer_.found.front().hits));
  }
  return std::move(answer_);
}

}  // namespace

StartCandidates searchStarts(const SearchMap& map, const SearchPoints& points, const SearchBox& box,
                             const SearchLimits& limits) {
  if (points.size() == 0) return {};
  return Search(map, points, box, limits).run();
}

}  // namespace paloc
