#pragma once

#include <cstddef>
#include <vector>

#include "paloc/map/point_kernels.h"
#include "plane_moments.h"

namespace paloc {

/// Points relative to a place (m), their coordinates side by side in single precision: what planes
/// are fitted to.
class NearPoints {
 public:
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  Eigen::Vector3f operator[](std::size_t i) const { return {x_[i], y_[i], z_[i]}; }
  PointColumns columns() const { return {x_.data(), y_.data(), z_.data(), size_}; }

  void add(float x, float y, float z);
  /// To be called after the last point was added.
  void close();
  /// Takes the points that write(columns) writes instead; it returns their number, `most` at most.
  template <typename Write>
  void fill(std::size_t most, const Write& write) {
    reserve(most);
    size_ = write(PackedColumns{x_.data(), y_.data(), z_.data()});
    close();
  }

 private:
  static constexpr std::size_t kRoom = 8;  // behind the last point

  void reserve(std::size_t size);

  std::size_t size_ = 0;
  std::vector<float> x_, y_, z_;
};

inline Place3f toPlace(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

inline MomentSums toMomentSums(const RegionSums& sums) {
  MomentSums moments;
  moments.count = sums.count;
  for (std::size_t i = 0; i < 3; ++i) moments.first[i] = static_cast<double>(sums.first[i]);
  for (std::size_t i = 0; i < 6; ++i) moments.second[i] = static_cast<double>(sums.second[i]);
  return moments;
}

}  // namespace paloc
