#include "paloc/map/occupancy_map.h"

#include <octomap/OcTree.h>

#include <cmath>
#include <sstream>

#include "cell_set.h"
#include "cell_walk.h"
#include "output_file.h"
#include "point_vector.h"

namespace paloc {
namespace {

constexpr int kHalfCells = 1 << 15;  // of an octree, along each axis, to each side of its origin
constexpr double kRound_m = 10;
// A node of the library takes 16 bytes, its allocation 32; an inner one's array of children 80.
constexpr double kBytesPerNode = 42;

// A quarter of the octree stays for what lies about the origin of the rays.
Vec3 treeOrigin(const Vec3& rays_origin, double resolution_m) {
  const double reach_m = 0.75 * kHalfCells * resolution_m;
  if (rays_origin.cwiseAbs().maxCoeff() < reach_m) return Vec3::Zero();
  return kRound_m * (rays_origin / kRound_m).array().round().matrix();
}

bool isInside(const Vec3& cells) {
  return cells.minCoeff() >= -kHalfCells && cells.maxCoeff() < kHalfCells;
}

octomap::OcTreeKey keyOf(const CellSet::Cell& cell) {
  const auto part = [](int c) { return static_cast<octomap::key_type>(c + kHalfCells); };
  return {part(cell[0]), part(cell[1]), part(cell[2])};
}

}  // namespace

struct OccupancyMap::Impl {
  Impl(const OccupancySettings& s, const Vec3& rays_origin)
      : settings(s),
        origin(treeOrigin(rays_origin, s.resolution_m)),
        shift(rays_origin - origin),
        tree(s.resolution_m) {}

  double memoryMb() const { return 1e-6 * kBytesPerNode * static_cast<double>(tree.size()); }

  void gather(const Vec3& from, Vec3 to) {
    const double range_m = (to - from).norm();
    const bool met = range_m <= settings.max_range_m;
    if (!met) to = from + settings.max_range_m / range_m * (to - from);
    const Vec3 start = from / settings.resolution_m, end = to / settings.resolution_m;
    if (!isInside(start) || !isInside(end)) {
      ++rays_outside;
      return;
    }
    walkCells(start, end, [this](const CellSet::Cell& cell) {
      free.insert(cell);
      return true;
    });
    if (!met) return;
    occupied.insert({static_cast<int>(std::floor(end.x())), static_cast<int>(std::floor(end.y())),
                     static_cast<int>(std::floor(end.z()))});
  }

  OccupancySettings settings;
  Vec3 origin, shift;  // shift: of the rays' origin in the tree's frame
  octomap::OcTree tree;
  CellSet free, occupied;  // of the scan at hand
  std::size_t scans = 0, rays_outside = 0;
};

OccupancyMap::OccupancyMap(const OccupancySettings& settings, const Vec3& rays_origin)
    : impl_(std::make_unique<Impl>(settings, rays_origin)) {}

OccupancyMap::~OccupancyMap() = default;

// Every cell is updated once, so the order does not matter for what comes out.
bool OccupancyMap::insert(const ScanRays& scan) {
  Impl& m = *impl_;
  if (m.memoryMb() > m.settings.max_memory_mb) return false;
  m.free.clear();
  m.occupied.clear();
  for (std::size_t i = 0; i < scan.to.size(); ++i) {
    m.gather(m.shift + toVec(scan.from[i]), m.shift + toVec(scan.to[i]));
  }
  m.free.forEach([&m](const CellSet::Cell& cell) {
    if (!m.occupied.contains(cell)) m.tree.updateNode(keyOf(cell), false);
  });
  m.occupied.forEach([&m](const CellSet::Cell& cell) { m.tree.updateNode(keyOf(cell), true); });
  ++m.scans;
  return true;
}

const Vec3& OccupancyMap::origin() const { return impl_->origin; }

OccupancyMap::State OccupancyMap::at(const Vec3& p_map) const {
  const Vec3 p = (p_map - impl_->origin) / impl_->settings.resolution_m;
  if (!isInside(p)) return State::kUnknown;
  const octomap::OcTreeNode* node = impl_->tree.search(
      keyOf({static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
             static_cast<int>(std::floor(p.z()))}));
  if (node == nullptr) return State::kUnknown;
  return impl_->tree.isNodeOccupied(node) ? State::kOccupied : State::kFree;
}

std::size_t OccupancyMap::scans() const { return impl_->scans; }
std::size_t OccupancyMap::cells() const { return impl_->tree.getNumLeafNodes(); }
std::size_t OccupancyMap::raysOutside() const { return impl_->rays_outside; }
double OccupancyMap::memoryMb() const { return impl_->memoryMb(); }

// The header is written here: the library's own writer prints to the console.
void OccupancyMap::save(const std::filesystem::path& path) {
  octomap::OcTree& tree = impl_->tree;
  tree.toMaxLikelihood();
  tree.prune();
  std::ostringstream content;
  content.precision(12);
  content << "# Octomap OcTree binary file\n";
  if (impl_->origin.isZero(0)) {
    content << "# in the prior map's frame\n";
  } else {
    content << "# add (" << impl_->origin.x() << ", " << impl_->origin.y() << ", "
            << impl_->origin.z() << ") m to come to the prior map's frame\n";
  }
  content << "id OcTree\nsize " << tree.size() << "\nres " << tree.getResolution() << "\ndata\n";
  if (tree.getRoot() != nullptr) tree.writeBinaryNode(content, tree.getRoot());
  OutputFile file(path);
  file.write(content.str());
  file.close();
}

}  // namespace paloc
