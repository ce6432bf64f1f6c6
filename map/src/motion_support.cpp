#include "motion_support.h"

#include <algorithm>

namespace paloc {
namespace {

constexpr float kConstrainingCosine = 0.1F;  // well above the noise of any normal
// So many times four rows are summed in single precision, which loses nothing that matters.
constexpr std::size_t kRun = 32;

}  // namespace

// Lanes that are none have no weight, and normals that see no motion.
SupportRows::SupportRows(std::span<const PlaneRow> rows, double normal_noise_rad)
    : lanes_((rows.size() + 3) / 4, Lanes{}) {
  const double floor_var = normal_noise_rad * normal_noise_rad;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PlaneRow& row = rows[i];
    Lanes& lanes = lanes_[i / 4];
    const std::size_t lane = i % 4;
    const double normal_var = floor_var + row.normal_sigma * row.normal_sigma;
    const double weight = 1 / row.variance;
    for (int axis = 0; axis < 3; ++axis) {
      lanes.normal[axis][lane] = static_cast<float>(row.normal_body[axis]);
      lanes.point[axis][lane] = static_cast<float>(row.point_body[axis]);
    }
    lanes.weight[lane] = static_cast<float>(weight);
    lanes.unweighted[lane] = static_cast<float>(weight / row.robust_weight);
    lanes.normal_var[lane] = static_cast<float>(normal_var);
    lanes.range_var[lane] = static_cast<float>(row.range_variance);
    normal_noise_ += normal_var * weight;
    levered_noise_ += normal_var * weight * row.point_body.squaredNorm();
  }
}

inline void SupportRows::add(const Lanes& rows, const Motion& motion, Sums& sums) {
  const Eigen::Vector3f v = motion.v.cast<float>(), w = motion.w.cast<float>();
  const auto& [nx, ny, nz] = rows.normal;
  const auto& [px, py, pz] = rows.point;
  const Float4 mx = v.x() + w.y() * pz - w.z() * py, my = v.y() + w.z() * px - w.x() * pz,
               mz = v.z() + w.x() * py - w.y() * px;
  const Float4 along = nx * mx + ny * my + nz * mz, turn = nx * w.x() + ny * w.y() + nz * w.z();
  const Float4 along_sq = along * along, motion_sq = mx * mx + my * my + mz * mz;
  const Float4 noise_var = rows.normal_var * max4(motion_sq - along_sq, Float4{}) +
                           rows.range_var * max4(w.squaredNorm() - turn * turn, Float4{});
  const Float4 signal = rows.weight * along_sq;
  sums.signal += signal;
  sums.squares += signal * signal;
  sums.unweighted += rows.unweighted * along_sq;
  sums.noise_mean += rows.weight * noise_var;
  // Of the square of a normal variable with mean `along`.
  sums.variance += rows.weight * rows.weight * noise_var * (2 * noise_var + 4 * along_sq);
  sums.count += where(along_sq > kConstrainingCosine * kConstrainingCosine * motion_sq, all4(1));
}

std::array<Support, 3> SupportRows::of(const std::array<Motion, 3>& motions) const {
  std::array<Support, 3> supports;
  const auto total = [](const Float4& lanes) { return static_cast<double>(sumOf(lanes)); };
  for (std::size_t begin = 0; begin < lanes_.size(); begin += kRun) {
    const std::size_t end = std::min(begin + kRun, lanes_.size());
    for (std::size_t k = 0; k < motions.size(); ++k) {
      Sums sums;
      for (std::size_t i = begin; i < end; ++i) add(lanes_[i], motions[k], sums);
      supports[k].count += total(sums.count);
      supports[k].signal += total(sums.signal);
      supports[k].noise_mean += total(sums.noise_mean);
      supports[k].variance += total(sums.variance);
      supports[k].unweighted += total(sums.unweighted);
      supports[k].squares += total(sums.squares);
    }
  }
  return supports;
}

}  // namespace paloc
