#include "wall_faces.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "parallel_chunks.h"

namespace paloc {
namespace {

constexpr std::size_t kGroup = 64, kChunk = 64;  // points; groups
constexpr std::size_t kLeastPoints = 5;          // of a face
constexpr float kThinnestM = 0.03F, kThickestM = 0.3F;
constexpr float kParallelCosine = 0.95F;
constexpr float kSameFaceM = 0.02F;
constexpr int kAboutNeeded = 3;  // of four places about

using Vec3f = Eigen::Vector3f;

Vec3f toVec(const Point3f& p) { return {p.x, p.y, p.z}; }

/// Looks for the other face of the wall that a plane may belong to.
class OtherFace {
 public:
  OtherFace(const PointIndex& index, const PlaneStore& planes, const Vec3f& point,
            const Vec3f& normal, float spacing_m)
      : index_(index),
        planes_(planes),
        point_(point),
        normal_(normal),
        aside_m_(std::max(0.08F, 1.2F * spacing_m)),
        about_m_(std::max(0.15F, 1.5F * spacing_m)) {}

  /// The side of the plane where it lies: 1 where the normal points, -1 behind, 0 nowhere or on
  /// both sides.
  float side() const {
    const bool before = liesAt(Vec3f::Zero(), 1), behind = liesAt(Vec3f::Zero(), -1);
    if (before == behind) return 0;
    const float side = before ? 1 : -1;
    const Vec3f u = normal_.unitOrthogonal(), v = normal_.cross(u);
    int about = 0, opposite = 0;
    for (const Vec3f& aside : {u, v, Vec3f(-u), Vec3f(-v)}) {
      about += liesAt(about_m_ * aside, side);
      opposite += liesAt(about_m_ * aside, -side);
    }
    return about >= kAboutNeeded && opposite == 0 ? side : 0;
  }

 private:
  // Whether a parallel plane lies on that side of the place (relative to the point).
  bool liesAt(const Vec3f& place, float side) const {
    const Vec3f from = point_ + place;
    constexpr float kMiddleM = (kThinnestM + kThickestM) / 2;
    const Vec3f middle = from + side * kMiddleM * normal_;
    const float half_m = kThickestM - kMiddleM;
    const auto fits = [&](std::uint32_t index) {
      const Vec3f apart = toVec(index_.point(index)) - from;
      const float height = side * normal_.dot(apart);
      if (height < kThinnestM || height > kThickestM) return false;
      if (apart.squaredNorm() - height * height > aside_m_ * aside_m_) return false;
      const PackedPlane& plane = planes_[index];
      return plane.planar() && std::abs(plane.normal().dot(normal_)) > kParallelCosine;
    };
    return index_
               .nearest({middle.x(), middle.y(), middle.z()}, half_m * half_m + aside_m_ * aside_m_,
                        fits)
               .index != PointIndex::kNone;
  }

  const PointIndex& index_;
  const PlaneStore& planes_;
  Vec3f point_, normal_;
  float aside_m_, about_m_;
};

/// What is to become of a plane.
enum class Turn : std::uint8_t { kNothing, kKeep, kTurn };

float spacingOf(const PointIndex& index, std::size_t first, std::size_t count) {
  Vec3f low = toVec(index.point(static_cast<std::uint32_t>(first))), high = low;
  for (std::size_t i = 1; i < count; ++i) {
    const Vec3f p = toVec(index.point(static_cast<std::uint32_t>(first + i)));
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
    const Vec3f point = toVec(index.point(static_cast<std::uint32_t>(i)));
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

void decide(const PointIndex& index, const PlaneStore& planes, std::size_t first, Turn* turns) {
  const std::size_t count = std::min(kGroup, index.size() - first);
  const float spacing_m = spacingOf(index, first, count);
  for (const Face& face : facesIn(index, planes, first, count)) {
    if (face.points.size() < kLeastPoints) continue;
    // About a point in the middle of those of the face.
    const std::size_t middle = face.points[face.points.size() / 2];
    const Vec3f point = toVec(index.point(static_cast<std::uint32_t>(middle)));
    const float side = OtherFace(index, planes, point, face.normal, spacing_m).side();
    if (side == 0) continue;
    for (const std::size_t i : face.points) {
      turns[i - first] = side * planes[i].normal().dot(face.normal) > 0 ? Turn::kTurn : Turn::kKeep;
    }
  }
}

}  // namespace

void turnFacesToTheirViewers(const PointIndex& index, PlaneStore& planes, tbb::task_arena& arena) {
  // First all decisions, from planes that nobody changes meanwhile.
  std::vector<Turn> turns(index.size(), Turn::kNothing);
  forEachChunk(arena, chunkCount(index.size(), kGroup), kChunk,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t group = begin; group < end; ++group) {
                   decide(index, planes, group * kGroup, turns.data() + group * kGroup);
                 }
               });
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (turns[i] != Turn::kNothing) planes[i].orient(turns[i] == Turn::kTurn);
  }
}

}  // namespace paloc
