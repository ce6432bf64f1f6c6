#include "paloc/map/map_information.h"

#include <cmath>
#include <cstddef>

namespace paloc {
namespace {

constexpr double kSamePlaneCosine = 0.978;  // 12 degrees
constexpr double kSamePlaneHeightM = 0.1;
constexpr double kSharedThickness = 0.25;  // of the square

struct PatchSums {
  Vec6 jacobian = Vec6::Zero();  // Y_k
  double weight = 0;             // sum 1/D
  double range = 0;              // g_k
  double residual = 0;           // sum r/D
};

}  // namespace

NormalEquations sharedErrorEquations(std::span<const PlaneRow> rows, const SharedErrors& shared) {
  std::vector<PatchSums> sums(shared.patch_variances.size());
  NormalEquations equations;
  Vec6 range_jacobian = Vec6::Zero();
  double range_weight = 0, range_residual = 0;
  for (const PlaneRow& row : rows) {
    const Vec6 j = row.jacobian();
    const double weight = 1 / row.variance;
    const Vec6 weighted = weight * j;
    equations.information.noalias() += weighted * j.transpose();
    equations.gradient += weighted * row.residual;
    range_jacobian += row.range_factor * weighted;
    range_weight += weight * row.range_factor * row.range_factor;
    range_residual += weight * row.range_factor * row.residual;
    if (row.patch < 0 || sums.empty()) continue;
    PatchSums& patch = sums[static_cast<std::size_t>(row.patch)];
    patch.jacobian += weighted;
    patch.weight += weight;
    patch.range += weight * row.range_factor;
    patch.residual += weight * row.residual;
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (shared.patch_variances[k] <= 0) continue;
    const PatchSums& patch = sums[k];
    const double inverse = 1 / (1 / shared.patch_variances[k] + patch.weight);
    equations.information.noalias() -= inverse * patch.jacobian * patch.jacobian.transpose();
    equations.gradient -= (inverse * patch.residual) * patch.jacobian;
    range_jacobian -= (inverse * patch.range) * patch.jacobian;
    range_weight -= inverse * patch.range * patch.range;
    range_residual -= inverse * patch.range * patch.residual;
  }
  if (shared.range_bias_m > 0) {
    const double inverse = 1 / (1 / (shared.range_bias_m * shared.range_bias_m) + range_weight);
    equations.information.noalias() -= inverse * range_jacobian * range_jacobian.transpose();
    equations.gradient -= (inverse * range_residual) * range_jacobian;
  }
  equations.information =
      (0.5 * (equations.information + equations.information.transpose())).eval();
  return equations;
}

std::vector<double> assignPatches(std::span<PlaneRow> rows, double patch_m, double plane_bias_m) {
  struct Patch {
    Vec3 normal, point;
    double thickness_sq = 0;
    int rows = 0;
  };
  std::vector<Patch> patches;
  const double patch_sq = patch_m * patch_m;
  for (PlaneRow& row : rows) {
    std::size_t index = 0;
    for (; index < patches.size(); ++index) {
      const Patch& patch = patches[index];
      if (std::abs(patch.normal.dot(row.normal_body)) < kSamePlaneCosine) continue;
      const Vec3 apart = row.point_body - patch.point;
      // Measured along the mean of both normals: each alone is uncertain over a long lever.
      const double sign = patch.normal.dot(row.normal_body) < 0 ? -1 : 1;
      const double height = apart.dot(patch.normal + sign * row.normal_body) / 2;
      if (std::abs(height) < kSamePlaneHeightM && apart.squaredNorm() < patch_sq) break;
    }
    if (index == patches.size()) patches.push_back({row.normal_body, row.point_body});
    row.patch = static_cast<int>(index);
    patches[index].thickness_sq += row.surface_sigma * row.surface_sigma;
    ++patches[index].rows;
  }
  std::vector<double> variances(patches.size());
  for (std::size_t k = 0; k < patches.size(); ++k) {
    variances[k] =
        plane_bias_m * plane_bias_m + kSharedThickness * patches[k].thickness_sq / patches[k].rows;
  }
  return variances;
}

Mat6 informationInMap(const Mat6& information_body, const Mat3& R_map_body) {
  Mat6 turned = information_body;
  turned.topLeftCorner<3, 3>() =
      R_map_body * information_body.topLeftCorner<3, 3>() * R_map_body.transpose();
  turned.topRightCorner<3, 3>() = R_map_body * information_body.topRightCorner<3, 3>();
  turned.bottomLeftCorner<3, 3>() = turned.topRightCorner<3, 3>().transpose();
  return (0.5 * (turned + turned.transpose())).eval();
}

}  // namespace paloc
