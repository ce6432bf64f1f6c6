#include "neighbourhood.h"

#include <algorithm>

namespace paloc {
namespace {

constexpr float kFar = 1e15F;  // its square is finite

}  // namespace

void Neighbourhood::append(const PointBlock& block, float reach_sq) {
  if (x_.size() < size_ + 2 * PointBlock::kPoints) {
    x_.resize(2 * (size_ + 2 * PointBlock::kPoints));
    y_.resize(x_.size());
    z_.resize(x_.size());
  }
  for (std::size_t at = 0; at < PointBlock::kPoints; at += 4) {
    const Float4 x = load4(block.x + at) - centre_.x, y = load4(block.y + at) - centre_.y,
                 z = load4(block.z + at) - centre_.z;
    unsigned bits = bitsOf(x * x + y * y + z * z < reach_sq);
    if (bits == 0xf) {
      store4(x_.data() + size_, x), store4(y_.data() + size_, y), store4(z_.data() + size_, z);
      size_ += 4;
      continue;
    }
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      x_[size_] = x[lane], y_[size_] = y[lane], z_[size_] = z[lane];
      ++size_;
    }
  }
}

void Neighbourhood::gather(const Point3f& centre, float reach_m) {
  centre_ = centre;
  size_ = 0;
  const float reach_sq = reach_m * reach_m;
  index_.visitNear(centre, reach_sq, [&](const PointBlock& block) { append(block, reach_sq); });
  if (x_.size() < size_ + 4) x_.resize(size_ + 4), y_.resize(size_ + 4), z_.resize(size_ + 4);
  for (std::size_t i = size_; i < size_ + 4; ++i) x_[i] = y_[i] = z_[i] = kFar;
}

float Neighbourhood::distanceSq(const Point3f& from, std::size_t count) {
  if (count > size_) return std::numeric_limits<float>::infinity();
  distances_sq_.resize(size_ + 4);
  for (std::size_t at = 0; at < size_; at += 4) {
    const Float4 dx = load4(x_.data() + at) - from.x, dy = load4(y_.data() + at) - from.y,
                 dz = load4(z_.data() + at) - from.z;
    store4(distances_sq_.data() + at, dx * dx + dy * dy + dz * dz);
  }
  const auto wanted = distances_sq_.begin() + static_cast<std::ptrdiff_t>(count - 1);
  std::nth_element(distances_sq_.begin(), wanted,
                   distances_sq_.begin() + static_cast<std::ptrdiff_t>(size_));
  return *wanted;
}

Neighbourhood::Sums Neighbourhood::sumsWithin(const Point3f& from, float radius_sq) const {
  Float4 count{}, sx{}, sy{}, sz{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
  const Float4 one = all4(1);
  for (std::size_t at = 0; at < size_; at += 4) {
    Float4 x = load4(x_.data() + at) - from.x, y = load4(y_.data() + at) - from.y,
           z = load4(z_.data() + at) - from.z;
    const Mask4 within = x * x + y * y + z * z <= radius_sq;
    if (bitsOf(within) == 0) continue;
    x = where(within, x), y = where(within, y), z = where(within, z);
    count += where(within, one);
    sx += x, sy += y, sz += z;
    xx += x * x, xy += x * y, xz += x * z;
    yy += y * y, yz += y * z, zz += z * z;
  }
  const auto total = [](const Float4& lanes) { return static_cast<double>(sumOf(lanes)); };
  return {{total(sx), total(sy), total(sz), total(xx), total(xy), total(xz), total(yy), total(yz),
           total(zz)},
          static_cast<int>(sumOf(count))};
}

std::span<const Point3f> Neighbourhood::pointsWithin(const Point3f& from, float radius_sq) {
  neighbours_.clear();
  for (std::size_t at = 0; at < size_; at += 4) {
    const Float4 x = load4(x_.data() + at) - from.x, y = load4(y_.data() + at) - from.y,
                 z = load4(z_.data() + at) - from.z;
    const Float4 distance_sq = x * x + y * y + z * z;
    for (unsigned bits = bitsOf(distance_sq <= radius_sq); bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      neighbours_.push_back({{x[lane], y[lane], z[lane]}, distance_sq[lane]});
    }
  }
  std::nth_element(
      neighbours_.begin(),
      neighbours_.begin() + static_cast<std::ptrdiff_t>(neighbours_.size() / 2), neighbours_.end(),
      [](const Neighbour& a, const Neighbour& b) { return a.distance_sq < b.distance_sq; });
  points_.clear();
  for (const Neighbour& neighbour : neighbours_) points_.push_back(neighbour.relative);
  return points_;
}

}  // namespace paloc
