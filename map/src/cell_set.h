#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace paloc {

/// A set of cells of a grid, for the cells along rays: cubes of 8 x 8 x 8 cells are bit masks, and
/// the cube of the last cell is remembered.
class CellSet {
 public:
  using Cell = std::array<int, 3>;

  void clear() {
    cubes_.clear();
    masks_.clear();
    last_ = nullptr;
  }
  void insert(const Cell& cell) {
    Mask& mask = maskAt(cell);
    mask[static_cast<std::size_t>(cell[2] & 7)] |= bitOf(cell);
  }
  bool contains(const Cell& cell) const {
    const auto found = cubes_.find(cubeOf(cell));
    return found != cubes_.end() &&
           (masks_[found->second][static_cast<std::size_t>(cell[2] & 7)] & bitOf(cell)) != 0;
  }
  /// Cube by cube in a fixed order that keeps neighbours together.
  template <typename Visit>
  void forEach(const Visit& visit) const {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(cubes_.begin(), cubes_.end());
    std::sort(order.begin(), order.end());
    for (const auto& [cube, index] : order) {
      const Cell low = lowOf(cube);
      for (std::size_t z = 0; z < 8; ++z) {
        for (std::uint64_t bits = masks_[index][z]; bits != 0; bits &= bits - 1) {
          const int bit = std::countr_zero(bits);
          visit(Cell{low[0] + (bit & 7), low[1] + (bit >> 3), low[2] + static_cast<int>(z)});
        }
      }
    }
  }

 private:
  using Mask = std::array<std::uint64_t, 8>;  // by z; in each, x + 8 y
  static constexpr int kShift = 1 << 20;

  static std::uint64_t bitOf(const Cell& cell) {
    return 1ULL << ((cell[0] & 7) + 8 * (cell[1] & 7));
  }
  static std::uint64_t cubeOf(const Cell& cell) {
    const auto part = [](int c) {
      const int cube = (c >> 3) + kShift;
      return static_cast<std::uint64_t>(cube);
    };
    return part(cell[0]) << 42 | part(cell[1]) << 21 | part(cell[2]);
  }
  static Cell lowOf(std::uint64_t cube) {
    const auto part = [cube](int shift) {
      return (static_cast<int>(cube >> shift & 0x1fffff) - kShift) * 8;
    };
    return {part(42), part(21), part(0)};
  }
  Mask& maskAt(const Cell& cell) {
    const std::uint64_t cube = cubeOf(cell);
    if (last_ == nullptr || cube != last_cube_) {
      const auto [place, is_new] =
          cubes_.try_emplace(cube, static_cast<std::uint32_t>(masks_.size()));
      if (is_new) masks_.emplace_back();
      last_ = &masks_[place->second];
      last_cube_ = cube;
    }
    return *last_;
  }

  std::unordered_map<std::uint64_t, std::uint32_t> cubes_;
  std::vector<Mask> masks_;
  Mask* last_ = nullptr;
  std::uint64_t last_cube_ = 0;
};

}  // namespace paloc
