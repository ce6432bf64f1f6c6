#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "lanes4.h"
#include "plane_moments.h"

namespace paloc {

/// Points relative to a place (m), their coordinates side by side in single precision: what planes
/// are fitted to.
class NearPoints {
 public:
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  Eigen::Vector3f operator[](std::size_t i) const { return {x_[i], y_[i], z_[i]}; }

  void add(float x, float y, float z) {
    reserve(1);
    x_[size_] = x, y_[size_] = y, z_[size_] = z;
    ++size_;
  }
  /// Adds those of four whose bit is set.
  void add(const Float4& x, const Float4& y, const Float4& z, unsigned bits);
  /// To be called after the last point: fills the last lanes with what no comparison holds for.
  void close();

  /// Calls visit(x, y, z) for four points after four; the last may be none (NaN).
  template <typename Visit>
  void forEach4(const Visit& visit) const {
    for (std::size_t at = 0; at < size_; at += 4) {
      visit(load4(x_.data() + at), load4(y_.data() + at), load4(z_.data() + at));
    }
  }

  /// Moments about `from` of the points that `keep(x, y, z)`, relative to `from`, holds for.
  template <typename Keep>
  MomentSums sumsWhere(const Eigen::Vector3f& from, const Keep& keep) const;
  template <typename Keep>
  MomentSums sumsWhere(const Keep& keep) const {
    return sumsWhere(Eigen::Vector3f::Zero(), keep);
  }

 private:
  void reserve(std::size_t more) {
    if (x_.size() < size_ + more + 4) grow(size_ + more + 4);
  }
  void grow(std::size_t least);

  std::size_t size_ = 0;
  std::vector<float> x_, y_, z_;
};

template <typename Keep>
MomentSums NearPoints::sumsWhere(const Eigen::Vector3f& from, const Keep& keep) const {
  Float4 count{}, sx{}, sy{}, sz{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
  const Float4 one = all4(1);
  forEach4([&](Float4 x, Float4 y, Float4 z) {
    x -= from.x(), y -= from.y(), z -= from.z();
    const Mask4 kept = keep(x, y, z);
    if (bitsOf(kept) == 0) return;
    x = where(kept, x), y = where(kept, y), z = where(kept, z);
    count += where(kept, one);
    sx += x, sy += y, sz += z;
    xx += x * x, xy += x * y, xz += x * z;
    yy += y * y, yz += y * z, zz += z * z;
  });
  const auto total = [](const Float4& lanes) { return static_cast<double>(sumOf(lanes)); };
  return {static_cast<int>(sumOf(count)),
          {total(sx), total(sy), total(sz)},
          {total(xx), total(xy), total(xz), total(yy), total(yz), total(zz)}};
}

inline void NearPoints::add(const Float4& x, const Float4& y, const Float4& z, unsigned bits) {
  reserve(4);
  if (bits == 0xf) {
    store4(x_.data() + size_, x), store4(y_.data() + size_, y), store4(z_.data() + size_, z);
    size_ += 4;
    return;
  }
  for (unsigned lane = 0; lane < 4; ++lane) {
    // Written in any case: what is not to be kept is written over by the next.
    x_[size_] = x[lane], y_[size_] = y[lane], z_[size_] = z[lane];
    size_ += (bits >> lane) & 1U;
  }
}

inline void NearPoints::close() {
  reserve(4);
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = size_; i < size_ + 4; ++i) x_[i] = y_[i] = z_[i] = kNone;
}

inline void NearPoints::grow(std::size_t least) {
  for (std::vector<float>* axis : {&x_, &y_, &z_}) axis->resize(2 * least);
}

}  // namespace paloc
