#include "paloc/map/surface_patches.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace paloc {
namespace {

constexpr double kMatters = 1e-3;

}  // namespace

// Normal and point are weighted like the gradient.
std::vector<SurfacePatch> surfacePatches(std::span<const PlaneRow> rows) {
  std::vector<SurfacePatch> patches;
  std::vector<double> weights;
  for (const PlaneRow& row : rows) {
    if (row.patch < 0) continue;
    const auto k = static_cast<std::size_t>(row.patch);
    patches.resize(std::max(patches.size(), k + 1));
    weights.resize(patches.size());
    const double weight = 1 / row.variance;
    patches[k].gradient += weight * row.jacobian();
    patches[k].normal += weight * row.normal_body;
    patches[k].point += weight * row.point_body;
    weights[k] += weight;
  }
  for (std::size_t k = 0; k < patches.size(); ++k) {
    if (weights[k] <= 0) continue;
    patches[k].normal.normalize();
    patches[k].point /= weights[k];
  }
  return patches;
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
