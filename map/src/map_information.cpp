#include "paloc/map/map_information.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "patch_sums.h"

namespace paloc {
namespace {

constexpr double kSamePlaneCosine = 0.978;  // 12 degrees
constexpr double kSamePlaneHeightM = 0.1;
constexpr int kKnownRows = 5;              // of a patch, for its normal to be known
constexpr double kSharedThickness = 0.25;  // of the square, beyond white noise

using Vec4f = float __attribute__((vector_size(16)));
using Vec4i = std::int32_t __attribute__((vector_size(16)));

// What single precision may be wrong by, generously.
constexpr float kSlackM = 1e-3F, kSlackCosine = 1e-4F;

// Rows on one surface: their mean normal and centroid, which a single row's are far off of over a
// long lever. Of many rows they change little with one more, and are only brought up to date now
// and then.
struct Patch {
  Vec3 normal_sum = Vec3::Zero(), point_sum = Vec3::Zero();
  double thickness_sq = 0;
  int rows = 0;
  Vec3 normal = Vec3::Zero(), point = Vec3::Zero();  // of the sums

  /// Whether normal and point have changed.
  bool add(const PlaneRow& row) {
    normal_sum += row.normal_body;
    point_sum += row.point_body;
    thickness_sq += row.surface_sigma * row.surface_sigma;
    ++rows;
    if (rows > 8 && rows % (rows / 8) != 0) return false;
    summarize();
    return true;
  }
  void add(const Patch& other) {
    normal_sum += other.normal_sum;
    point_sum += other.point_sum;
    thickness_sq += other.thickness_sq;
    rows += other.rows;
    summarize();
  }

  void summarize() {
    normal = normal_sum.normalized();
    point = point_sum / rows;
  }
};

bool liesOn(const PlaneRow& row, const Patch& patch, double patch_sq) {
  if (patch.normal.dot(row.normal_body) < kSamePlaneCosine) return false;
  const Vec3 apart = row.point_body - patch.point;
  return std::abs(apart.dot(patch.normal)) < kSamePlaneHeightM && apart.squaredNorm() < patch_sq;
}

// Whether two patches are parts of one surface, both of them known well enough to tell.
bool areOne(const Patch& a, const Patch& b, double patch_sq) {
  if (a.normal.dot(b.normal) < kSamePlaneCosine) return false;
  const Vec3 apart = b.point - a.point;
  return std::abs(apart.dot(a.normal + b.normal)) < 2 * kSamePlaneHeightM &&
         apart.squaredNorm() < patch_sq;
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
    const Vec4f height = ax * nx + ay * ny + az * nz;
    constexpr float kLowCosine = static_cast<float>(kSamePlaneCosine) - kSlackCosine;
    constexpr float kHigh = static_cast<float>(kSamePlaneHeightM) + kSlackM;
    return (cosine > kLowCosine) & (height * height < kHigh * kHigh);
  }
};

bool any(const Vec4i& lanes) {
  using Vec2l = std::int64_t __attribute__((vector_size(16)));
  const auto halves = reinterpret_cast<Vec2l>(lanes);  // the same bits
  return (halves[0] | halves[1]) != 0;
}

// The patch of the row before, where the row lies on it; else the first that it lies on, or their
// number.
std::size_t patchFor(const PlaneRow& row, std::size_t before, const std::vector<Patch>& patches,
                     const std::vector<PatchGroup>& groups, double patch_sq) {
  if (before < patches.size() && liesOn(row, patches[before], patch_sq)) return before;
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

// A row far from the first one of its surface may have opened a patch of its own, before the mean
// normal was known: such patches become one, the earlier of the two. Returns where each went; of
// patches that went elsewhere `patches` keeps what they were.
std::vector<int> mergePatches(std::vector<Patch>& patches, double patch_sq) {
  std::vector<int> merged(patches.size());
  for (std::size_t k = 0; k < patches.size(); ++k) {
    std::size_t into = k;
    if (patches[k].rows >= kKnownRows) {
      for (std::size_t i = 0; i < k; ++i) {
        if (merged[i] != static_cast<int>(i) || patches[i].rows < kKnownRows) continue;
        if (!areOne(patches[i], patches[k], patch_sq)) continue;
        patches[i].add(patches[k]);
        into = i;
        break;
      }
    }
    merged[k] = static_cast<int>(into);
  }
  return merged;
}

}  // namespace

NormalEquations leastSquares(std::span<const PlaneRow> rows) {
  NormalEquations equations;
  Mat6 upper = Mat6::Zero();
  for (const PlaneRow& row : rows) {
    const Vec6 j = row.jacobian();
    const Vec6 weighted = j / row.variance;
    for (int column = 0; column < 6; ++column) {
      for (int k = 0; k <= column; ++k) upper(k, column) += weighted[k] * j[column];
    }
    equations.gradient += weighted * row.residual;
  }
  equations.information = upper.selfadjointView<Eigen::Upper>();
  return equations;
}

Mat6 sharedSpread(std::span<const PlaneRow> rows, const SharedErrors& shared) {
  return spreadOf(sumsOf(rows), shared);
}

std::vector<double> assignPatches(std::span<PlaneRow> rows, double patch_m, double plane_bias_m,
                                  double map_noise_m) {
  std::vector<Patch> patches;
  std::vector<PatchGroup> groups;
  const double patch_sq = patch_m * patch_m;
  std::size_t index = 0;
  for (PlaneRow& row : rows) {
    index = patchFor(row, index, patches, groups, patch_sq);
    if (index == patches.size()) {
      patches.emplace_back();
      if (index % 4 == 0) groups.emplace_back();
    }
    row.patch = static_cast<int>(index);
    if (patches[index].add(row)) groups[index / 4].set(index % 4, patches[index]);
  }
  for (Patch& patch : patches) patch.summarize();
  const std::vector<int> merged = mergePatches(patches, patch_sq);
  for (PlaneRow& row : rows) row.patch = merged[static_cast<std::size_t>(row.patch)];
  std::vector<double> variances(patches.size());
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const double thickness_sq = patches[k].thickness_sq / patches[k].rows;
    const double excess_sq = std::max(thickness_sq - map_noise_m * map_noise_m, 0.0);
    variances[k] = plane_bias_m * plane_bias_m + kSharedThickness * excess_sq;
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
