#include "paloc/tools/free_level.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace paloc::synth {
namespace {

using Place = FreeLevel::Place;

constexpr int kSteps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

}  // namespace

FreeLevel::FreeLevel(const OctreeMap& map, int layer, double clearance_m) {
  Place low{std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
  Place high{std::numeric_limits<int>::min(), std::numeric_limits<int>::min()};
  const auto atLayer = [layer](const OctreeMap::Leaf& leaf) {
    return leaf.state == OctreeMap::State::kFree && layer >= leaf.low[2] &&
           layer < leaf.low[2] + leaf.edge;
  };
  map.forEachLeaf([&](const OctreeMap::Leaf& leaf) {
    if (!atLayer(leaf)) return;
    low = {std::min(low.x, leaf.low[0]), std::min(low.y, leaf.low[1])};
    high = {std::max(high.x, leaf.low[0] + leaf.edge), std::max(high.y, leaf.low[1] + leaf.edge)};
  });
  if (low.x >= high.x) return;
  low_ = low;
  width_ = static_cast<std::size_t>(high.x - low.x);
  height_ = static_cast<std::size_t>(high.y - low.y);
  clear_.assign(width_ * height_, 0);
  map.forEachLeaf([&](const OctreeMap::Leaf& leaf) {
    if (!atLayer(leaf)) return;
    for (int y = 0; y < leaf.edge; ++y) {
      for (int x = 0; x < leaf.edge; ++x) {
        clear_[indexOf({leaf.low[0] + x, leaf.low[1] + y})] = 1;
      }
    }
  });
  block(map, layer, clearance_m);
  keepLargestPart();
  measureBorders();
}

bool FreeLevel::inside(Place p) const {
  return p.x >= low_.x && p.y >= low_.y && p.x < low_.x + static_cast<int>(width_) &&
         p.y < low_.y + static_cast<int>(height_);
}

bool FreeLevel::clear(Place place) const { return inside(place) && clear_[indexOf(place)] != 0; }

void FreeLevel::block(const OctreeMap& map, int layer, double clearance_m) {
  // From the middle of a cell to the far side of another: half a cell's diagonal more.
  const double reach = clearance_m / map.resolution() + 0.87;
  const int cells = static_cast<int>(reach);
  std::vector<std::uint8_t> seen(clear_.size(), 0);
  const auto blockAbout = [&](Place p) {
    for (int y = -cells; y <= cells; ++y) {
      for (int x = -cells; x <= cells; ++x) {
        const Place near{p.x + x, p.y + y};
        if (std::hypot(x, y) <= reach && inside(near)) clear_[indexOf(near)] = 0;
      }
    }
  };
  map.forEachPatch([&](const OctreeMap::Patch& patch) {
    forEachCell(patch, [&](const OctreeMap::Cell& cell) {
      if (std::abs(cell[2] - layer) > cells) return;
      const Place p{cell[0], cell[1]};
      if (inside(p)) {
        if (seen[indexOf(p)] != 0) return;
        seen[indexOf(p)] = 1;
      }
      blockAbout(p);
    });
  });
}

void FreeLevel::keepLargestPart() {
  std::vector<std::uint32_t> part(clear_.size(), 0);
  std::uint32_t parts = 0, largest = 0;
  for (std::size_t start = 0; start < clear_.size(); ++start) {
    if (clear_[start] == 0 || part[start] != 0) continue;
    part[start] = ++parts;
    std::vector<std::size_t> queue{start};
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (int k = 0; k < 4; ++k) {
        const Place here = placeOf(queue[i]);
        const Place next{here.x + kSteps[k][0], here.y + kSteps[k][1]};
        if (!clear(next) || part[indexOf(next)] != 0) continue;
        part[indexOf(next)] = parts;
        queue.push_back(indexOf(next));
      }
    }
    if (queue.size() <= size_) continue;
    size_ = queue.size();
    largest = parts;
  }
  for (std::size_t i = 0; i < clear_.size(); ++i) clear_[i] = part[i] == largest && largest != 0;
}

void FreeLevel::measureBorders() {
  constexpr auto kFar = std::numeric_limits<std::uint16_t>::max();
  to_border_.assign(clear_.size(), kFar);
  std::vector<std::size_t> queue;
  for (std::size_t i = 0; i < clear_.size(); ++i) {
    const Place p = placeOf(i);
    bool border = clear_[i] == 0;
    for (int k = 0; k < 4; ++k)
      border = border || !inside({p.x + kSteps[k][0], p.y + kSteps[k][1]});
    if (!border) continue;
    to_border_[i] = 0;
    queue.push_back(i);
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const Place here = placeOf(queue[i]);
    for (int k = 0; k < 4; ++k) {
      const Place next{here.x + kSteps[k][0], here.y + kSteps[k][1]};
      if (!inside(next) || to_border_[indexOf(next)] != kFar) continue;
      to_border_[indexOf(next)] = static_cast<std::uint16_t>(to_border_[queue[i]] + 1);
      queue.push_back(indexOf(next));
    }
  }
}

// Dijkstra's search: for each place the one before it on the way from `from`.
std::vector<std::size_t> FreeLevel::search(std::size_t from, std::size_t& furthest) const {
  std::vector<std::size_t> before(clear_.size(), kNowhere);
  std::vector<double> cost(clear_.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  cost[from] = 0;
  queue.push({0, from});
  furthest = from;
  while (!queue.empty()) {
    const auto [here_cost, here] = queue.top();
    queue.pop();
    if (here_cost > cost[here]) continue;
    furthest = here;  // they come in the order of their cost
    const Place place = placeOf(here);
    for (const auto& step : kSteps) {
      const Place next{place.x + step[0], place.y + step[1]};
      if (!clear(next)) continue;
      const std::size_t index = indexOf(next);
      const double edge = 1 + 3.0 / (1 + to_border_[index]);
      const double next_cost = here_cost + edge * std::hypot(step[0], step[1]);
      if (next_cost >= cost[index]) continue;
      cost[index] = next_cost;
      before[index] = here;
      queue.push({next_cost, index});
    }
  }
  return before;
}

std::vector<FreeLevel::Place> FreeLevel::longestWay() const {
  const auto any = std::find(clear_.begin(), clear_.end(), 1);
  if (any == clear_.end()) return {};
  std::size_t end = 0, start = 0;
  search(static_cast<std::size_t>(any - clear_.begin()), start);
  const std::vector<std::size_t> before = search(start, end);
  std::vector<Place> way;
  for (std::size_t i = end; i != kNowhere; i = before[i]) way.push_back(placeOf(i));
  return way;
}

}  // namespace paloc::synth
