#include "near_points.h"

#include <algorithm>
#include <limits>

namespace paloc {

void NearPoints::add(float x, float y, float z) {
  reserve(size_ + 1);
  x_[size_] = x, y_[size_] = y, z_[size_] = z;
  ++size_;
}

void NearPoints::close() {
  reserve(size_);
  for (std::vector<float>* axis : {&x_, &y_, &z_}) {
    std::fill_n(axis->begin() + static_cast<std::ptrdiff_t>(size_), kRoom,
                std::numeric_limits<float>::quiet_NaN());
  }
}

void NearPoints::reserve(std::size_t size) {
  if (x_.size() >= size + kRoom) return;
  for (std::vector<float>* axis : {&x_, &y_, &z_}) axis->resize(2 * (size + kRoom));
}

}  // namespace paloc
