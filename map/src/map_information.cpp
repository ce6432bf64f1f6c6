#include "paloc/map/map_information.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace paloc {
namespace {

constexpr double kSamePlaneCosine = 0.978;  // 12 degrees
constexpr double kSamePlaneHeightM = 0.1;
constexpr double kSharedThickness = 0.25;  // of the square

using Vec4f = float __attribute__((vector_size(16)));
using Vec4i = std::int32_t __attribute__((vector_size(16)));

// What single precision may be wrong by, generously.
constexpr float kSlackM = 1e-3F, kSlackCosine = 1e-4F;

struct Patch {
  Vec3 normal, point;
  double thickness_sq = 0;
  int rows = 0;
};

bool liesOn(const PlaneRow& row, const Patch& patch, double patch_sq) {
  const double cosine = patch.normal.dot(row.normal_body);
  if (std::abs(cosine) < kSamePlaneCosine) return false;
  const Vec3 apart = row.point_body - patch.point;
  // Measured along the mean of both normals: each alone is uncertain over a long lever.
  const double sign = cosine < 0 ? -1 : 1;
  const double height = apart.dot(patch.normal + sign * row.normal_body) / 2;
  return std::abs(height) < kSamePlaneHeightM && apart.squaredNorm() < patch_sq;
}

// Four patches side by side, in single precision, to leave out at once what is far from fitting.
struct PatchGroup {
  Vec4f nx{}, ny{}, nz{}, px{}, py{}, pz{};  // a lane not in use has no normal and fits nothing

  void set(std::size_t lane, const Patch& patch) {
    nx[lane] = static_cast<float>(patch.normal.x());
    ny[lane] = static_cast<float>(patch.normal.y());
    nz[lane] = static_cast<float>(patch.normal.z());
    px[lane] = static_cast<float>(patch.point.x());
    py[lane] = static_cast<float>(patch.point.y());
    pz[lane] = static_cast<float>(patch.point.z());
  }

  // The lanes that may fit: all that liesOn() accepts, unless the scan is kilometres wide.
  Vec4i mayFit(const Eigen::Vector3f& n, const Eigen::Vector3f& p) const {
    const Vec4f cosine = nx * n.x() + ny * n.y() + nz * n.z();
    const Vec4f ax = p.x() - px, ay = p.y() - py, az = p.z() - pz;
    const Vec4f own = ax * n.x() + ay * n.y() + az * n.z();
    const Vec4f other = ax * nx + ay * ny + az * nz;
    const Vec4f twice_height = cosine < 0 ? other - own : other + own;
    constexpr float kLowCosine = static_cast<float>(kSamePlaneCosine) - kSlackCosine;
    constexpr float kTwiceHigh = 2 * static_cast<float>(kSamePlaneHeightM) + kSlackM;
    return (cosine * cosine > kLowCosine * kLowCosine) &
           (twice_height * twice_height < kTwiceHigh * kTwiceHigh);
  }
};

bool any(const Vec4i& lanes) {
  using Vec2l = std::int64_t __attribute__((vector_size(16)));
  const auto halves = reinterpret_cast<Vec2l>(lanes);  // the same bits
  return (halves[0] | halves[1]) != 0;
}

// The first of the patches that the row lies on, or their number.
std::size_t firstPatch(const PlaneRow& row, const std::vector<Patch>& patches,
                       const std::vector<PatchGroup>& groups, double patch_sq) {
  const Eigen::Vector3f normal = row.normal_body.cast<float>(),
                        point = row.point_body.cast<float>();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Vec4i lanes = groups[g].mayFit(normal, point);
    if (!any(lanes)) continue;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if (lanes[lane] != 0 && liesOn(row, patches[4 * g + lane], patch_sq)) return 4 * g + lane;
    }
  }
  return patches.size();
}

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
  Mat6 upper = Mat6::Zero();
  Vec6 range_jacobian = Vec6::Zero();
  double range_weight = 0, range_residual = 0;
  for (const PlaneRow& row : rows) {
    const Vec6 j = row.jacobian();
    const double weight = 1 / row.variance;
    const Vec6 weighted = weight * j;
    for (int column = 0; column < 6; ++column) {
      for (int k = 0; k <= column; ++k) upper(k, column) += weighted[k] * j[column];
    }
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
  equations.information = upper.selfadjointView<Eigen::Upper>();
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
  std::vector<Patch> patches;
  std::vector<PatchGroup> groups;
  const double patch_sq = patch_m * patch_m;
  for (PlaneRow& row : rows) {
    const std::size_t index = firstPatch(row, patches, groups, patch_sq);
    if (index == patches.size()) {
      patches.push_back({row.normal_body, row.point_body});
      if (index % 4 == 0) groups.emplace_back();
      groups.back().set(index % 4, patches.back());
    }
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
