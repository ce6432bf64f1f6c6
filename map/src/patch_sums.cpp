#include "patch_sums.h"

#include <algorithm>
#include <cstddef>

namespace paloc {
namespace {

// A patch whose mean residual is more than so many squared standard deviations stands elsewhere.
constexpr double kSureSquare = 9;

}  // namespace

RowSums sumsOf(std::span<const PlaneRow> rows) {
  RowSums sums;
  for (const PlaneRow& row : rows) {
    const double weight = 1 / row.variance;
    const Vec6 weighted = weight * row.jacobian();
    sums.range += row.range_factor * weighted;
    if (row.patch < 0) continue;
    const auto k = static_cast<std::size_t>(row.patch);
    if (k >= sums.patches.size()) sums.patches.resize(k + 1);
    PatchSums& patch = sums.patches[k];
    patch.gradient += weighted;
    patch.normal += weighted.head<3>();
    patch.point += weight * row.point_body;
    patch.weight += weight;
    patch.residual += weight * row.residual;
  }
  return sums;
}

Mat6 spreadOf(const RowSums& sums, const SharedErrors& shared) {
  Mat6 spread = (shared.range_bias_m * shared.range_bias_m) * sums.range * sums.range.transpose();
  const std::size_t count = std::min(sums.patches.size(), shared.patch_variances.size());
  for (std::size_t k = 0; k < count; ++k) {
    const PatchSums& patch = sums.patches[k];
    if (patch.weight <= 0) continue;
    const double mean = patch.residual / patch.weight;
    const double expected = shared.patch_variances[k] + 1 / patch.weight;
    const bool wrong = mean * mean > kSureSquare * expected;
    const double variance = wrong ? mean * mean : shared.patch_variances[k];
    spread += variance * patch.gradient * patch.gradient.transpose();
  }
  return spread;
}

}  // namespace paloc
