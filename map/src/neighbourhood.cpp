#include "neighbourhood.h"

#include <algorithm>
#include <limits>

#include "point_vector.h"

namespace paloc {
namespace {

constexpr int kMaxGuesses = 8;
constexpr float kRoundedDown = 1 - 1e-5F;

}  // namespace

void Neighbourhood::prepare(const Point3f& place, float reach_m) {
  prepared_ = place;
  prepared_m_ = reach_m;
  if (reach_m > 0) index_.groupsNear(place, reach_m * reach_m, groups_);
}

void Neighbourhood::gather(const Point3f& centre, float reach_m) {
  const float reach_sq = reach_m * reach_m;
  const float aside_m = (toVec3f(centre) - toVec3f(prepared_)).norm();
  if (aside_m + reach_m < kRoundedDown * prepared_m_) {
    index_.blocksNear(groups_, centre, reach_sq, blocks_);
  } else {
    index_.blocksNear(centre, reach_sq, blocks_);
  }
  points_.fill(blocks_.count * PointBlock::kPoints, [&](const PackedColumns& columns) {
    return kernels_.gather(index_.allBlocks(), blocks_.found(), {centre.x, centre.y, centre.z},
                           reach_sq, columns);
  });
}

// On a surface the number of points grows with the square of the radius.
float Neighbourhood::radiusSqOf(std::size_t count, const Eigen::Vector3f& from, float within_sq,
                                float about_sq) {
  distances_sq_.resize(points_.size() + PointBlock::kPoints);
  kernels_.distancesSq(points_.columns(), toPlace(from), distances_sq_.data());
  const auto countWithin = [this](float radius_sq) {
    return static_cast<std::size_t>(
        kernels_.countUpTo(distances_sq_.data(), points_.size(), radius_sq));
  };
  if (countWithin(within_sq) < count) return std::numeric_limits<float>::infinity();
  const std::size_t most = count + count / 8;
  float radius_sq = std::min(about_sq, within_sq);
  for (int i = 0; i < kMaxGuesses && radius_sq > 0; ++i) {
    const std::size_t within = countWithin(radius_sq);
    if (within >= count && within <= most) return radius_sq;
    const float wanted = static_cast<float>(count + most) / 2;
    radius_sq *= wanted / static_cast<float>(std::max<std::size_t>(within, 1));
    radius_sq = std::min(radius_sq, within_sq);
  }
  const auto last = distances_sq_.begin() + static_cast<std::ptrdiff_t>(count - 1);
  std::nth_element(distances_sq_.begin(), last,
                   distances_sq_.begin() + static_cast<std::ptrdiff_t>(points_.size()));
  return *last;
}

Neighbourhood::Face Neighbourhood::faceWithin(const Eigen::Vector3f& from, float radius_sq,
                                              const Eigen::Vector3f& normal, float height_m,
                                              float within_m) const {
  const RegionSums sums = kernels_.sumsIn(
      points_.columns(),
      {toPlace(from), radius_sq, toPlace(normal), height_m - within_m, height_m + within_m});
  return {toMomentSums(sums), sums.within};
}

const NearPoints& Neighbourhood::pointsWithin(const Eigen::Vector3f& from, float radius_sq) {
  selected_.fill(points_.size(), [&](const PackedColumns& columns) {
    return kernels_.select(points_.columns(), toPlace(from), radius_sq, columns);
  });
  return selected_;
}

}  // namespace paloc
