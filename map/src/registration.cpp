#include "registration.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "parallel_chunks.h"

namespace paloc {
namespace {

constexpr std::size_t kChunk = 256;
constexpr double kMinIncidenceCosine =
    0.1;  // flatter rays say little and are biased by their footprint
constexpr double kNoiseCosine =
    0.2;                         // below it the range noise counts no less: the beam has a width
constexpr double kKernel = 3.0;  // of the Geman-McClure kernel, in robust standard deviations
constexpr double kInlier = 3.0;  // the same, for what counts as an inlier
constexpr double kMadToSigma = 1.4826;
constexpr double kConvergedM = 1e-4, kConvergedRad = 2e-5;
constexpr double kLongestStepM = 0.5, kLongestStepRad = 0.2;
constexpr double kAnchorSigma = 1e-4;  // m or rad: holds a free direction at the start
constexpr int kMinRows = 12;
constexpr int kRestlessIterations =
    6;  // from then on a point has to move further and further to be
constexpr double kRestlessGrowth =
    1.5;  // matched anew, so that matches that flip back and forth settle

Vec3 toVec(const Point3f& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

Point3f toPoint(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Pose movedInBody(const Pose& pose, const Vec6& delta) {
  Vec6 in_map = delta;
  in_map.head<3>() = pose.rotation * delta.head<3>();
  return boxplus(pose, in_map);
}

Vec6 differenceInBody(const Pose& to, const Pose& from) {
  Vec6 delta = boxminus(to, from);
  delta.head<3>() = (from.rotation.transpose() * delta.head<3>()).eval();
  return delta;
}

/// Directions that are held at the start, as rows of a prior.
class Anchors {
 public:
  void hold(const ObservedDirections& observed) {
    axes_.clear();
    for (std::size_t i = 0; i < 6; ++i) {
      const MatchDirection& direction = observed.directions[i];
      if (direction.cls != DirectionClass::kNone) continue;
      Vec6 axis = Vec6::Zero();
      axis.segment<3>(i < 3 ? 0 : 3) = direction.axis_body;
      axes_.push_back(axis);
    }
  }

  void addTo(NormalEquations& equations, const Vec6& from_start) const {
    const double weight = 1 / (kAnchorSigma * kAnchorSigma);
    for (const Vec6& axis : axes_) {
      equations.information += weight * axis * axis.transpose();
      equations.gradient += (weight * axis.dot(from_start)) * axis;
    }
  }

 private:
  std::vector<Vec6> axes_;
};

// The Gauss-Newton step, no longer than is believed; false when there is none.
bool solveStep(const NormalEquations& equations, Vec6& step) {
  using Matrix = Eigen::Matrix<double, 6, 6>;
  const Matrix information = equations.information;
  const double floor = 1e-9 * information.diagonal().maxCoeff();
  const Eigen::LDLT<Matrix> ldlt(information + floor * Matrix::Identity());
  if (ldlt.info() != Eigen::Success || !ldlt.isPositive()) return false;
  step = -ldlt.solve(Eigen::Matrix<double, 6, 1>(equations.gradient));
  if (!step.allFinite()) return false;
  const double longest =
      std::max(step.head<3>().norm() / kLongestStepM, step.tail<3>().norm() / kLongestStepRad);
  if (longest > 1) step /= longest;
  return true;
}

}  // namespace

void Registration::setPoints(std::vector<Point3f> points_body, const Vec3& sensor_position_body) {
  points_ = std::move(points_body);
  sensor_body_ = sensor_position_body;
  matches_.assign(points_.size(), {});
}

// The nearest map point and its plane. Planes seen edge-on are none.
void Registration::search(Correspondence& match, const Vec3& position, const Vec3& sensor) const {
  match.searched_at = position;
  match.planar = false;
  const PriorMap::Nearest nearest = map_.nearest(toPoint(position), reach_);
  match.near = nearest.found();
  if (!nearest.found()) return;
  match.distance = std::sqrt(static_cast<double>(nearest.distance_sq));
  const MapPlane plane = map_.plane(nearest.index);
  if (!plane.planar()) return;
  match.normal = Vec3(static_cast<double>(plane.nx), static_cast<double>(plane.ny),
                      static_cast<double>(plane.nz));
  const Vec3 ray = (position - sensor).normalized();
  if (std::abs(match.normal.dot(ray)) < kMinIncidenceCosine) return;
  match.planar = true;
  match.map_point = toVec(map_.point(nearest.index));
  match.height = match.normal.dot(match.map_point) + static_cast<double>(plane.offset_m);
  const auto thickness = static_cast<double>(plane.thickness_m);
  // The point of the scan lies anywhere in the thickness of the surface, the fit has its own error.
  const double roughness = std::max(thickness, settings_.map_noise_m);
  match.fit_variance = roughness * roughness + thickness * thickness / plane.points;
  match.normal_sigma = static_cast<double>(plane.normal_sigma_rad);
  match.surface_sigma = thickness;
}

void Registration::associate(const Pose& pose, double gate, int iteration) {
  const double research = settings_.research_distance_m *
                          std::pow(kRestlessGrowth, std::max(iteration - kRestlessIterations, 0));
  const double research_sq = research * research;
  const Vec3 sensor = pose * sensor_body_;
  reach_ = static_cast<float>(gate);
  forEachChunk(arena_, points_.size(), kChunk,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   const Vec3 position = pose * toVec(points_[i]);
                   Correspondence& match = matches_[i];
                   if ((position - match.searched_at).squaredNorm() > research_sq) {
                     search(match, position, sensor);
                   }
                 }
               });
  matched_.clear();
  near_ = 0;
  for (std::size_t i = 0; i < matches_.size(); ++i) {
    if (!matches_[i].near || matches_[i].distance > gate) continue;
    ++near_;
    if (matches_[i].planar) matched_.push_back(static_cast<std::uint32_t>(i));
  }
}

PlaneRow Registration::rowOf(std::size_t point, const Mat3& R_body_local, const Pose& pose) const {
  const Correspondence& match = matches_[point];
  PlaneRow row;
  row.point_body = toVec(points_[point]);
  row.normal_body = R_body_local * match.normal;
  const Vec3 position = pose * row.point_body;
  row.residual = match.normal.dot(position) - match.height;
  const Vec3 ray = row.point_body - sensor_body_;
  const double range = ray.norm();
  row.range_factor = range > 0 ? row.normal_body.dot(ray) / range : 0;
  row.normal_sigma = match.normal_sigma;
  row.surface_sigma = match.surface_sigma;
  const double cosine = std::max(std::abs(row.range_factor), kNoiseCosine);
  const double lever = (position - match.map_point).norm() * match.normal_sigma;
  const double range_part = settings_.range_noise_m * cosine;
  row.variance = range_part * range_part + match.fit_variance + lever * lever;
  return row;
}

void Registration::linearize(const Pose& pose) {
  rows_.resize(matched_.size());
  sigmas_.resize(matched_.size());
  const Mat3 R_body_local = pose.rotation.transpose();
  forEachChunk(arena_, matched_.size(), kChunk,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) {
                   rows_[k] = rowOf(matched_[k], R_body_local, pose);
                   sigmas_[k] = std::sqrt(rows_[k].variance);
                 }
               });
}

// Standard deviation of the residuals in units of their expected one, robustly, at least 1: data
// that fit better than the data sheet says are not believed more than it.
double Registration::robustScale() {
  scratch_.resize(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    scratch_[k] = std::abs(rows_[k].residual) / sigmas_[k];
  }
  const auto middle = scratch_.begin() + static_cast<std::ptrdiff_t>(scratch_.size() / 2);
  std::nth_element(scratch_.begin(), middle, scratch_.end());
  return std::max(1.0, kMadToSigma * *middle);
}

// Iteratively reweighted least squares with the kernel of Geman and McClure: weight (1 +
// z^2/k^2)^-2.
void Registration::weigh(double scale) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const double z = rows_[k].residual / (scale * sigmas_[k] * kKernel);
    const double spread = scale * (1 + z * z);
    rows_[k].variance = sigmas_[k] * sigmas_[k] * spread * spread;
  }
}

// The rows' patches; those of the same points remain from step to step, since by then these are
// small against a patch.
void Registration::assignPatchesOnce() {
  if (patched_ != matched_) {
    patched_ = matched_;
    shared_errors_.patch_variances =
        assignPatches(rows_, settings_.plane_patch_m, settings_.plane_bias_m);
    patches_.resize(rows_.size());
    for (std::size_t k = 0; k < rows_.size(); ++k) patches_[k] = rows_[k].patch;
    return;
  }
  for (std::size_t k = 0; k < rows_.size(); ++k) rows_[k].patch = patches_[k];
}

NormalEquations Registration::equations(bool shared) {
  if (shared) {
    assignPatchesOnce();
    return sharedErrorEquations(rows_, shared_errors_);
  }
  std::vector<NormalEquations> parts(chunkCount(rows_.size(), kChunk));
  forEachChunk(arena_, rows_.size(), kChunk,
               [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                 parts[chunk] = sharedErrorEquations({rows_.data() + begin, end - begin}, {});
               });
  NormalEquations sum;
  for (const NormalEquations& part : parts) {
    sum.information += part.information;
    sum.gradient += part.gradient;
  }
  return sum;
}

void Registration::summarize(double scale, Alignment& alignment) {
  alignment.near = near_;
  alignment.matched = static_cast<int>(matched_.size());
  if (rows_.empty()) return;
  double squares = 0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const double residual = std::abs(rows_[k].residual);
    scratch_[k] = residual;
    if (residual > kInlier * scale * sigmas_[k]) continue;
    ++alignment.inliers;
    squares += residual * residual;
  }
  if (alignment.inliers > 0) alignment.residual_rms_m = std::sqrt(squares / alignment.inliers);
  const auto middle = scratch_.begin() + static_cast<std::ptrdiff_t>(scratch_.size() / 2);
  std::nth_element(scratch_.begin(), middle, scratch_.end());
  alignment.residual_median_m = *middle;
}

Alignment Registration::align(const Pose& start, const AlignSchedule& schedule) {
  Alignment alignment;
  Pose pose = start;
  Anchors anchors;
  bool shared = false;
  double scale = 1;
  rows_.clear();
  patched_.clear();
  matches_.assign(points_.size(), {});
  for (int i = 0; i < schedule.max_iterations; ++i) {
    const bool first = i < schedule.first_iterations;
    associate(pose, first ? schedule.first_gate_m : schedule.gate_m, i);
    alignment.iterations = i + 1;
    if (matched_.size() < kMinRows) break;
    linearize(pose);
    scale = robustScale();
    weigh(scale);
    NormalEquations system = equations(shared);
    alignment.information_body = system.information;
    if (alignment.converged) break;
    if (i == 0 || i == schedule.first_iterations) {
      anchors.hold(observeDirections(rows_, system.information, noise()));
    }
    anchors.addTo(system, differenceInBody(pose, start));
    Vec6 step;
    if (!solveStep(system, step)) break;
    pose = movedInBody(pose, step);
    const bool small = step.head<3>().norm() < kConvergedM && step.tail<3>().norm() < kConvergedRad;
    if (!small || first) continue;
    alignment.converged = shared || !schedule.shared_errors;
    shared = schedule.shared_errors;
  }
  summarize(scale, alignment);
  alignment.T_local_body = pose;
  return alignment;
}

}  // namespace paloc
