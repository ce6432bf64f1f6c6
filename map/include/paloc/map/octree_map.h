#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// An occupancy map as OctoMap writes it (.bt, .ot; A. Hornung et al., "OctoMap: An Efficient
/// Probabilistic 3D Mapping Framework Based on Octrees", 2013), read whole: which cells of a grid
/// are known to be free, known to be occupied, or not known. Space is 2^16 cells wide.
class PALOC_EXPORT OctreeMap {
 public:
  enum class State : std::uint8_t { kUnknown, kFree, kOccupied };

  /// Cell (i, j, k) spans [i, i + 1) x [j, j + 1) x [k, k + 1) times the resolution.
  using Cell = std::array<int, 3>;

  /// A cube of cells of one state.
  struct Leaf {
    Cell low{};
    int edge = 1;  ///< cells
    State state = State::kUnknown;
  };

  /// A square of cells at the border of an occupied leaf, with one and the same state beyond it.
  struct Patch {
    Cell low{};
    int edge = 1;  ///< cells; 1 across the patch
    int face = 0;  ///< where beyond is: 0 to 5 for -x, +x, -y, +y, -z, +z
    State beyond = State::kUnknown;
  };

  /// Reads a file. Throws IoError in one sentence for one that is damaged or of another kind.
  static OctreeMap load(const std::filesystem::path& file);

  double resolution() const { return resolution_m_; }  ///< edge of a cell (m)
  const std::string& format() const { return format_; }
  State at(const Cell& cell) const;
  State at(const Vec3& p_map) const { return at(cellOf(p_map)); }
  Cell cellOf(const Vec3& p_map) const;
  Vec3 centre(const Cell& cell) const;  ///< m

  /// Calls for every leaf whose state is known.
  void forEachLeaf(const std::function<void(const Leaf&)>& visit) const;
  /// Calls for every patch of every occupied leaf that has no occupied cells beyond it.
  void forEachPatch(const std::function<void(const Patch&)>& visit) const;

 private:
  friend class OctreeMapReader;
  struct Node {
    std::uint32_t first_child = 0;  ///< of eight, one after the other; 0: this is a leaf
    State state = State::kUnknown;
  };

  void visitLeaves(std::uint32_t node, const Cell& low, int edge,
                   const std::function<void(const Leaf&)>& visit) const;
  std::uint32_t nodeAt(const Cell& low, int edge) const;
  void visitFace(std::uint32_t beyond, const Patch& patch,
                 const std::function<void(const Patch&)>& visit) const;

  double resolution_m_ = 0;
  std::string format_;
  std::vector<Node> nodes_{1};  ///< the first is the root
};

/// The cells next to a cell, in the order of a patch's faces.
PALOC_EXPORT OctreeMap::Cell neighbourOf(const OctreeMap::Cell& cell, int face);

/// Calls for every cell of a patch.
template <typename Visit>
void forEachCell(const OctreeMap::Patch& patch, const Visit& visit) {
  const std::size_t across = static_cast<std::size_t>(patch.face) / 2;
  const std::size_t u = (across + 1) % 3, v = (across + 2) % 3;
  OctreeMap::Cell cell = patch.low;
  for (int i = 0; i < patch.edge; ++i) {
    cell[u] = patch.low[u] + i;
    for (int k = 0; k < patch.edge; ++k) {
      cell[v] = patch.low[v] + k;
      visit(cell);
    }
  }
}

}  // namespace paloc
