#pragma once

#include <cstdint>
#include <vector>

#include "paloc/map/octree_map.h"

namespace paloc::synth {

/// A horizontal slice of an occupancy map: where a body can be that keeps clear of all that is
/// occupied.
class FreeLevel {
 public:
  struct Place {
    int x = 0, y = 0;  ///< cells
    bool operator==(const Place&) const = default;
  };

  /// The layer of cells `layer`, the body needing `clearance_m` about it to all sides, up and down
  /// included.
  FreeLevel(const OctreeMap& map, int layer, double clearance_m);

  /// The number of places in the largest connected part: the only ones that count as clear.
  std::size_t size() const { return size_; }
  bool clear(Place place) const;
  /// The two ends of the longest of the shortest ways from place to place (found by two searches,
  /// so nearly), and that way, place by place. Ways keep away from the border where they can.
  std::vector<Place> longestWay() const;

 private:
  std::size_t indexOf(Place p) const {
    return static_cast<std::size_t>(p.y - low_.y) * width_ + static_cast<std::size_t>(p.x - low_.x);
  }
  Place placeOf(std::size_t index) const {
    return {low_.x + static_cast<int>(index % width_), low_.y + static_cast<int>(index / width_)};
  }
  bool inside(Place p) const;
  void block(const OctreeMap& map, int layer, double clearance_m);
  void keepLargestPart();
  void measureBorders();
  std::vector<std::size_t> search(std::size_t from, std::size_t& furthest) const;

  Place low_;
  std::size_t width_ = 0, height_ = 0;
  std::vector<std::uint8_t> clear_;
  std::vector<std::uint16_t> to_border_;  ///< steps to the next place that is not clear
  std::size_t size_ = 0;
};

}  // namespace paloc::synth
