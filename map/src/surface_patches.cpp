#include "paloc/map/surface_patches.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "patch_sums.h"

namespace paloc {
namespace {

constexpr double kMatters = 1e-3;  // of the six variances of a pose, in their own units

}  // namespace

std::vector<SurfacePatch> surfacePatches(const RowSums& sums) {
  std::vector<SurfacePatch> patches;
  for (const PatchSums& sum : sums.patches) {
    if (sum.weight <= 0) continue;
    patches.push_back({sum.gradient, sum.normal.normalized(), sum.point / sum.weight});
  }
  return patches;
}

std::vector<SurfacePatch> surfacePatches(std::span<const PlaneRow> rows) {
  return surfacePatches(sumsOf(rows));
}

void keepWhatMatters(const Mat6& information, const Mat6& spread, double plane_bias_m,
                     std::vector<SurfacePatch>& patches) {
  using Square = Eigen::Matrix<double, 6, 6>;
  Square sum = information + spread;
  sum += 1e-12 * sum.diagonal().maxCoeff() * Square::Identity();
  const Eigen::LDLT<Square> factor = sum.ldlt();
  const double variance = plane_bias_m * plane_bias_m;
  std::erase_if(patches, [&](const SurfacePatch& patch) {
    const Vec6 moved = factor.solve(Eigen::Matrix<double, 6, 1>(patch.gradient));
    return variance * patch.gradient.dot(moved) < kMatters;
  });
}

}  // namespace paloc
