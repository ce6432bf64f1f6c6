#include "neighbourhood.h"

#include <algorithm>
#include <limits>

namespace paloc {
namespace {

constexpr int kMaxGuesses = 8;

Float4 normSq(const Float4& x, const Float4& y, const Float4& z) { return x * x + y * y + z * z; }

}  // namespace

void Neighbourhood::gather(const Point3f& centre, float reach_m) {
  points_.clear();
  const float reach_sq = reach_m * reach_m;
  index_.visitNear(centre, reach_sq, [&](const PointBlock& block) {
    for (std::size_t at = 0; at < PointBlock::kPoints; at += 4) {
      const Float4 x = load4(block.x + at) - centre.x, y = load4(block.y + at) - centre.y,
                   z = load4(block.z + at) - centre.z;
      const unsigned bits = bitsOf(normSq(x, y, z) < reach_sq);
      if (bits != 0) points_.add(x, y, z, bits);
    }
  });
  points_.close();
}

std::size_t Neighbourhood::countWithin(float radius_sq) const {
  Mask4 count{};
  for (std::size_t at = 0; at < points_.size(); at += 4) {
    count -= load4(distances_sq_.data() + at) <= radius_sq;  // a lane that holds is -1
  }
  const int sum = count[0] + count[1] + count[2] + count[3];
  return static_cast<std::size_t>(sum);
}

// On a surface the number of points grows with the square of the radius.
float Neighbourhood::radiusSqOf(std::size_t count, const Eigen::Vector3f& from, float within_sq,
                                float about_sq) {
  distances_sq_.resize(points_.size() + 4);
  std::size_t at = 0;
  points_.forEach4([&](Float4 x, Float4 y, Float4 z) {
    x -= from.x(), y -= from.y(), z -= from.z();
    store4(distances_sq_.data() + at, normSq(x, y, z));
    at += 4;
  });
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

MomentSums Neighbourhood::sumsWithin(const Eigen::Vector3f& from, float radius_sq) const {
  return points_.sumsWhere(from, [radius_sq](const Float4& x, const Float4& y, const Float4& z) {
    return normSq(x, y, z) <= radius_sq;
  });
}

Neighbourhood::Face Neighbourhood::faceWithin(const Eigen::Vector3f& from, float radius_sq,
                                              const Eigen::Vector3f& normal, float height_m,
                                              float within_m) const {
  Mask4 count{};
  const float within_sq = within_m * within_m;
  Face face;
  face.sums = points_.sumsWhere(from, [&](const Float4& x, const Float4& y, const Float4& z) {
    const Mask4 near = normSq(x, y, z) <= radius_sq;
    count -= near;  // a lane that holds is -1
    const Float4 off = x * normal.x() + y * normal.y() + z * normal.z() - height_m;
    return near & (off * off <= within_sq);
  });
  face.count = count[0] + count[1] + count[2] + count[3];
  return face;
}

const NearPoints& Neighbourhood::pointsWithin(const Eigen::Vector3f& from, float radius_sq) {
  selected_.clear();
  points_.forEach4([&](Float4 x, Float4 y, Float4 z) {
    x -= from.x(), y -= from.y(), z -= from.z();
    const unsigned bits = bitsOf(normSq(x, y, z) <= radius_sq);
    if (bits != 0) selected_.add(x, y, z, bits);
  });
  selected_.close();
  return selected_;
}

}  // namespace paloc
