#include "ray_targets.h"

#include <numeric>

namespace paloc {

RayTargets::RayTargets(std::vector<RayTarget> targets) : targets_(std::move(targets)) {
  std::vector<std::size_t> cell_of(targets_.size());
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const Cell cell = cellOf(targets_[i].position());
    const auto cube =
        cubes_.try_emplace(cubeOf(cell), static_cast<std::uint32_t>(cubes_.size())).first->second;
    cell_of[i] = 512 * static_cast<std::size_t>(cube) + inCube(cell);
  }
  starts_.assign(512 * cubes_.size() + 1, 0);
  for (const std::size_t cell : cell_of) ++starts_[cell + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  order_.resize(targets_.size());
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    order_[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
  }
}

void RayTargets::setPlane(std::uint32_t index, const MapPlane& plane) {
  RayTarget& target = targets_[index];
  target.nx = plane.planar() ? plane.nx : 0;
  target.ny = plane.planar() ? plane.ny : 0;
  target.nz = plane.planar() ? plane.nz : 0;
  target.offset_m = plane.planar() ? plane.offset_m : 0;
}

RayTargets::Cell RayTargets::cellOf(const Vec3& p) {
  const auto cell = [](double c) { return static_cast<int>(std::floor(c / kCell_m)); };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

}  // namespace paloc
