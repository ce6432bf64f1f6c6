#include "cloud_builder.h"
#include "cloud_readers.h"
#include "octree_map_reader.h"
#include "paloc/core/text.h"

/// An occupancy map as a cloud. That a cell is occupied says that the surface runs somewhere
/// through it, so the surface is taken to run through the middle of those occupied cells that
/// border free space: half a cell behind the face that is seen. A point on the face itself would
/// shift every surface by half a cell towards the viewer (2.5 cm at 5 cm, 10 cm at 20 cm), and
/// floors, which have no opposite, with it; in the middle, what is left is mostly the place of the
/// surface within the cell, with a twelfth of the edge squared as variance. A small bias towards
/// the viewer remains, since noise and oblique rays mark cells before the surface (simulated rooms,
/// range noise of 3 to 30 mm: up to 2 mm at 5 cm, 1 to 54 mm at 20 cm). Where a wall is one cell
/// thick, its two sides become one sheet. A large leaf gives a point for each of its cells
/// along its border, so that a plane has as many points there as elsewhere; what borders on nothing
/// known was never seen, and gives none.
namespace paloc {
namespace {

using Cell = OctreeMap::Cell;
using State = OctreeMap::State;

constexpr std::uint64_t kMostPoints = 2'000'000'000;

// A cell with several free faces is seen several times: it counts at the first.
bool seenBefore(const OctreeMap& map, const Cell& cell, int face) {
  for (int earlier = 0; earlier < face; ++earlier) {
    if (map.at(neighbourOf(cell, earlier)) == State::kFree) return true;
  }
  return false;
}

}  // namespace

PointCloud readOctree(const InputFile& file, const LoadOptions& options) {
  const MemoryBudget budget(options.memory_limit_bytes);
  const OctreeMap map = readOctreeMap(file, budget);
  std::uint64_t most = 0;
  map.forEachPatch([&](const OctreeMap::Patch& patch) {
    if (patch.beyond != State::kFree) return;
    most += static_cast<std::uint64_t>(patch.edge) * static_cast<std::uint64_t>(patch.edge);
  });
  if (most == 0) file.fail("has no occupied cell that borders free space");
  if (most > kMostPoints) file.fail(text("its surface has ", most, " cells, too many"));
  // A few bytes may stand for a block with millions of cells on its faces. Thinned or not: they are
  // as far apart as the map is fine, so little falls together, and time follows them, too.
  budget.require(most * sizeof(Point3f), text(file.name(), ": its surface of ", most, " cells"));
  const CloudFields fields({{"x"}, {"y"}, {"z"}}, file);
  CloudBuilder builder(file, fields, most, options);
  std::size_t rows = 0;
  map.forEachPatch([&](const OctreeMap::Patch& patch) {
    if (patch.beyond != State::kFree) return;
    forEachCell(patch, [&](const Cell& cell) {
      if (seenBefore(map, cell, patch.face)) return;
      const Vec3 p = map.centre(cell);
      builder.column(kX)[rows] = p.x();
      builder.column(kY)[rows] = p.y();
      builder.column(kZ)[rows] = p.z();
      if (++rows < CloudBuilder::kBlockRows) return;
      builder.addBlock(rows);
      rows = 0;
    });
  });
  builder.addBlock(rows);
  PointCloud cloud = builder.finish();
  cloud.format = map.format();
  return cloud;
}

}  // namespace paloc
