#include "wall_faces.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "near_points.h"
#include "parallel_chunks.h"
#include "point_vector.h"

namespace paloc {
namespace {

constexpr std::size_t kGroup = 64, kChunk = 64;  // points; groups
constexpr std::size_t kLeastPoints = 5;          // of a face
constexpr float kThinnestM = 0.03F, kThickestM = 0.3F;
constexpr float kParallelCosine = 0.95F, kSlackCosine = 1e-3F;
constexpr float kSameFaceM = 0.02F;
constexpr int kAboutNeeded = 3;  // of four places about

using Vec3f = Eigen::Vector3f;

/// Looks for the other faces of the walls that planes may belong to. One object serves one thread.
class OtherFace {
 public:
  OtherFace(const PointIndex& index, const PlaneStore& planes) : index_(index), planes_(planes) {}

  /// The side of the plane (through `point`) where it lies: 1 where the normal points, -1 behind, 0
  /// nowhere or on both sides.
  float side(const Vec3f& point, const Vec3f& normal, float spacing_m) {
    const float aside_m = std::max(0.08F, 1.2F * spacing_m),
                about_m = std::max(0.15F, 1.5F * spacing_m);
    aside_sq_ = aside_m * aside_m;
    normal_ = normal;
    gather(point, aside_m + about_m);
    const bool before = liesAt(Vec3f::Zero(), 1), behind = liesAt(Vec3f::Zero(), -1);
    if (before == behind) return 0;
    const float side = before ? 1 : -1;
    const Vec3f u = normal_.unitOrthogonal(), v = normal_.cross(u);
    int about = 0, opposite = 0;
    for (const Vec3f& aside : {u, v, Vec3f(-u), Vec3f(-v)}) {
      about += liesAt(about_m * aside, side);
      opposite += liesAt(about_m * aside, -side);
    }
    return about >= kAboutNeeded && opposite == 0 ? side : 0;
  }

 private:
  // All points on parallel planes that are not the point's own, as far as any place reaches.
  void gather(const Vec3f& point, float reach_m) {
    const float reach_sq = reach_m * reach_m;
    const Point3f centre{point.x(), point.y(), point.z()};
    index_.blocksNear(centre, kThickestM * kThickestM + reach_sq, blocks_);
    const std::size_t most = blocks_.count * PointBlock::kPoints;
    indices_.resize(std::max(indices_.size(), most + PointBlock::kPoints));
    aside_.fill(most, [&](const PackedColumns& columns) {
      return pointKernels().gatherAside(index_.allBlocks(), blocks_.found(),
                                        {toPlace(point), toPlace(normal_), kThinnestM * kThinnestM,
                                         kThickestM * kThickestM, reach_sq},
                                        columns, indices_.data());
    });
    candidates_.clear();
    for (std::size_t i = 0; i < aside_.size(); ++i) {
      const PackedPlane& plane = planes_[indices_[i]];
      if (plane.planar() && isParallel(plane)) candidates_.push_back(aside_[i]);
    }
  }

  // Only where it is close is the normal brought to unit length.
  bool isParallel(const PackedPlane& plane) const {
    const float nearly = std::abs(plane.along(normal_));
    if (nearly < kParallelCosine - kSlackCosine) return false;
    return nearly > kParallelCosine + kSlackCosine ||
           std::abs(plane.normal().dot(normal_)) > kParallelCosine;
  }

  // Whether a parallel plane lies on that side of the place (relative to the point).
  bool liesAt(const Vec3f& place, float side) const {
    return std::any_of(candidates_.begin(), candidates_.end(), [&](const Vec3f& candidate) {
      const Vec3f apart = candidate - place;
      const float height = side * normal_.dot(apart);
      return height > 0 && apart.squaredNorm() - height * height <= aside_sq_;
    });
  }

  const PointIndex& index_;
  const PlaneStore& planes_;
  Vec3f normal_ = Vec3f::Zero();
  float aside_sq_ = 0;
  PointIndex::NearBlocks blocks_;
  NearPoints aside_;
  std::vector<std::uint32_t> indices_;  // of these
  std::vector<Vec3f> candidates_;       // relative to the point
};

/// What is to become of a plane.
enum class Turn : std::uint8_t { kNothing, kKeep, kTurn };

float spacingOf(const PointIndex& index, std::size_t first, std::size_t count) {
  Vec3f low = toVec3f(index.point(static_cast<std::uint32_t>(first))), high = low;
  for (std::size_t i = 1; i < count; ++i) {
    const Vec3f p = toVec3f(index.point(static_cast<std::uint32_t>(first + i)));
    low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  const float side = (high - low).norm() / std::sqrt(static_cast<float>(count));
  return std::clamp(side, 0.01F, 0.25F);
}

/// The points of a group that lie on one face.
struct Face {
  Vec3f point, normal;
  std::vector<std::size_t> points;
};

// The faces in a group of neighbouring points, in their order.
std::vector<Face> facesIn(const PointIndex& index, const PlaneStore& planes, std::size_t first,
                          std::size_t count) {
  std::vector<Face> faces;
  for (std::size_t i = first; i < first + count; ++i) {
    if (!planes[i].planar()) continue;
    const Vec3f point = toVec3f(index.point(static_cast<std::uint32_t>(i)));
    const Vec3f normal = planes[i].normal();
    const auto face = std::find_if(faces.begin(), faces.end(), [&](const Face& known) {
      return std::abs(known.normal.dot(normal)) > kParallelCosine &&
             std::abs(known.normal.dot(point - known.point)) < kSameFaceM;
    });
    if (face == faces.end()) {
      faces.push_back({point, normal, {i}});
    } else {
      face->points.push_back(i);
    }
  }
  return faces;
}

void decide(const PointIndex& index, const PlaneStore& planes, std::size_t first, OtherFace& other,
            Turn* turns) {
  const std::size_t count = std::min(kGroup, index.size() - first);
  const float spacing_m = spacingOf(index, first, count);
  for (const Face& face : facesIn(index, planes, first, count)) {
    if (face.points.size() < kLeastPoints) continue;
    // About a point in the middle of those of the face.
    const std::size_t middle = face.points[face.points.size() / 2];
    const Vec3f point = toVec3f(index.point(static_cast<std::uint32_t>(middle)));
    const float side = other.side(point, face.normal, spacing_m);
    if (side == 0) continue;
    for (const std::size_t i : face.points) {
      turns[i - first] = side * planes[i].normal().dot(face.normal) > 0 ? Turn::kTurn : Turn::kKeep;
    }
  }
}

}  // namespace

void turnFacesToTheirViewers(const PointIndex& index, PlaneStore& planes, tbb::task_arena& arena) {
  // First all decisions, from planes that nobody changes meanwhile.
  RawArray<Turn> turns(index.size());
  std::fill(turns.begin(), turns.end(), Turn::kNothing);
  forEachChunk(arena, chunkCount(index.size(), kGroup), kChunk,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 OtherFace other(index, planes);
                 for (std::size_t group = begin; group < end; ++group) {
                   decide(index, planes, group * kGroup, other, turns.data() + group * kGroup);
                 }
               });
  forEachChunk(arena, planes.size(), kGroup * kChunk,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   if (turns[i] != Turn::kNothing) planes[i].orient(turns[i] == Turn::kTurn);
                 }
               });
}

}  // namespace paloc
