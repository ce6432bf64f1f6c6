#include "registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "alignment_step.h"
#include "median.h"
#include "parallel_chunks.h"
#include "patch_sums.h"
#include "point_vector.h"
#include "stopwatch.h"

namespace paloc {
namespace {

// Planes are kept while no point moves by more than this share of what has it matched anew.
constexpr double kKeptShare = 0.5;
constexpr double kKernel = 3.0;  // of the Geman-McClure kernel, in robust standard deviations
constexpr double kInlier = 3.0;  // the same, for what counts as an inlier
constexpr double kMadToSigma = 1.4826;
constexpr double kConvergedM = 2e-4, kConvergedRad = 4e-5;
// Steps below which the points of the first steps do no more.
constexpr double kNearM = 5e-3, kNearRad = 1e-3;
// Points that are enough for the first steps, for a scale on the way, and for a first look at the
// directions.
constexpr int kMoreRough = 3;  // further steps on these points, while the steps are long
constexpr std::size_t kCoarsePoints = 300, kScaleSample = 600, kGlimpse = 500;
constexpr double kLeastWideningM = 0.01, kWideGate = 3;
constexpr int kMinRows = 12;
// From so many steps on a point has to move further and further to be matched anew, so that matches
// that flip back and forth settle.
constexpr int kRestlessIterations = 6;
constexpr double kRestlessStartM = 1e-3, kRestlessGrowth = 1.5;

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

// Weight of iteratively reweighted least squares with the kernel of Geman and McClure, k standard
// deviations wide: (1 + z^2/k^2)^-2.
double robustWeight(double residual, double sigma_sq) {
  const double root = 1 + residual * residual / (kKernel * kKernel * sigma_sq);
  return 1 / (root * root);
}

// By how much the kernel is wider than the noise (m) once a direction was found weak: half as much
// each time, and nothing when it is of the noise's size.
double narrowed(double widening_m) {
  return widening_m < 2 * kLeastWideningM ? 0 : 0.5 * widening_m;
}

// Points are matched within it (m).
double gateAt(int iteration, const AlignSchedule& schedule, double widening_m) {
  if (iteration < schedule.first_iterations) return schedule.first_gate_m;
  return std::max(schedule.gate_m, std::min(schedule.first_gate_m, kWideGate * widening_m));
}

bool allFull(const std::array<MatchDirection, 6>& directions) {
  return std::all_of(directions.begin(), directions.end(), [](const MatchDirection& direction) {
    return direction.cls == DirectionClass::kFull;
  });
}

}  // namespace

// Seeks the planes of every stride-th point anew, where it moved, and measures their residuals.
void Registration::associate(const Pose& pose, double gate, int iteration, std::size_t stride) {
  const int restless = std::max(iteration - kRestlessIterations, 0);
  const double least = restless > 0 ? kRestlessStartM : 0;
  const double research =
      std::max(settings_.research_distance_m, least) * std::pow(kRestlessGrowth, restless);
  const double research_sq = research * research;
  const std::size_t count_all = chunkCount(planes_.size(), stride);
  collected_.resize(chunkCount(count_all, kChunk));
  forEachChunk(
      arena_, count_all, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        std::array<std::uint32_t, kChunk> moved{};
        std::array<Correspondence*, kChunk> anew{};
        std::size_t count = 0;
        for (std::size_t i = begin * stride; i < planes_.size() && i < end * stride; i += stride) {
          const Vec3 position = pose * planes_.point(i);
          Correspondence& match = matches_[i];
          const bool first = match.alignment != alignments_;
          if (first) {
            match.alignment = alignments_;
            match.map_index = PriorMap::kNoPoint;
          }
          if (first || (position - match.searched_at).squaredNorm() > research_sq) {
            match.searched_at = position;
            anew[count] = &match;
            moved[count++] = static_cast<std::uint32_t>(i);
          } else if (match.planar) {
            planes_.measure(match, i, position, pose.rotation);
          }
        }
        planes_.search(std::span(anew).first(count), pose, gate);
        for (std::size_t k = 0; k < count; ++k) {
          Correspondence& match = *anew[k];
          if (!match.planar) continue;
          planes_.measure(match, moved[k], match.searched_at, pose.rotation);
        }
        collect(begin * stride, std::min(end * stride, planes_.size()), stride, gate,
                collected_[chunk]);
      });
  joinCollected();
  fillLanes(pose);
  association_ = {pose, stride, gate};
}

// Whether these points need no new planes: none has moved by so much of what it takes as leaves
// room for what it had moved before.
bool Registration::holdsAt(const Pose& pose, double gate, std::size_t stride) const {
  if (association_.stride != stride || association_.gate != gate) return false;
  const Pose& before = association_.pose;
  const double turned = (pose.rotation - before.rotation).norm() / std::numbers::sqrt2;
  return (pose.position - before.position).norm() + turned * planes_.reach() <
         kKeptShare * settings_.research_distance_m;
}

// What is matched of every stride-th point in [begin, end).
void Registration::collect(std::size_t begin, std::size_t end, std::size_t stride, double gate,
                           Collected& collected) const {
  collected.near = collected.count = 0;
  for (std::size_t i = begin; i < end; i += stride) {
    if (!matches_[i].near || matches_[i].distance > gate) continue;
    ++collected.near;
    if (matches_[i].planar) collected.matched[collected.count++] = static_cast<std::uint32_t>(i);
  }
}

void Registration::joinCollected() {
  matched_.clear();
  near_ = 0;
  for (const Collected& part : collected_) {
    near_ += part.near;
    matched_.insert(matched_.end(), part.matched.begin(), part.matched.begin() + part.count);
  }
}

void Registration::fillLanes(const Pose& pose) {
  lanes_.reset(matched_.size(), pose);
  const Mat3 R_body_local = pose.rotation.transpose();
  forEachChunk(arena_, matched_.size(), kChunk,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) {
                   const Correspondence& match = matches_[matched_[k]];
                   lanes_.set(k, planes_.point(matched_[k]), R_body_local * match.normal,
                              match.residual, match.sigma * match.sigma);
                 }
               });
}

// Standard deviation of the residuals in units of their expected one, robustly, at least 1: data
// that fit better than the data sheet says are not believed more than it. Of many, from about
// `sample`, evenly.
double Registration::robustScale(std::size_t sample) {
  const std::size_t step = std::max<std::size_t>(lanes_.size() / sample, 1);
  scratch_.clear();
  for (std::size_t k = 0; k < lanes_.size(); k += step) {
    scratch_.push_back(lanes_.residual(k) * lanes_.residual(k) / lanes_.variance(k));
  }
  return std::max(1.0, kMadToSigma * std::sqrt(static_cast<double>(medianOf(scratch_))));
}

PlaneRow Registration::rowOf(std::size_t point, const Mat3& R_body_local, double scale) const {
  const Correspondence& match = matches_[point];
  PlaneRow row;
  row.point_body = planes_.point(point);
  row.normal_body = R_body_local * match.normal;
  row.residual = match.residual;
  row.range_factor = match.range_factor;
  row.range_variance = planes_.rangeVariance(point);
  row.normal_sigma = match.normal_sigma;
  row.surface_sigma = match.surface_sigma;
  row.robust_weight = robustWeight(match.residual, scale * scale * match.sigma * match.sigma);
  row.variance = scale * scale * match.sigma * match.sigma / row.robust_weight;
  return row;
}

// With residuals and variances of that pose.
void Registration::fillRows(const Pose& pose, double scale) {
  rows_.resize(matched_.size());
  const Mat3 R_body_local = pose.rotation.transpose();
  forEachChunk(arena_, matched_.size(), kChunk,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) {
                   const std::uint32_t i = matched_[k];
                   planes_.measure(matches_[i], i, pose * planes_.point(i), pose.rotation);
                   rows_[k] = rowOf(i, R_body_local, scale);
                 }
               });
}

Registration::Shared Registration::sharedErrorsOfRows() {
  const SharedErrors errors{
      assignPatches(rows_, settings_.plane_patch_m, settings_.plane_bias_m, settings_.map_noise_m),
      settings_.range_bias_m};
  const RowSums sums = sumsOf(rows_);
  return {spreadOf(sums, errors), surfacePatches(sums)};
}

// The rows of every `step`-th match, without their robust weights.
std::vector<PlaneRow> Registration::unweightedRows(const Pose& pose, double scale,
                                                   std::size_t step) const {
  const Mat3 R_body_local = pose.rotation.transpose();
  std::vector<PlaneRow> rows;
  for (std::size_t k = 0; k < matched_.size(); k += step) {
    rows.push_back(rowOf(matched_[k], R_body_local, scale));
    rows.back().variance *= rows.back().robust_weight;
    rows.back().robust_weight = 1;
  }
  return rows;
}

// The directions as some of the points see them; as all do, where some leave a doubt. Without
// robust weights: where the start is wrong along a direction, the few points that could tell are
// far off their planes, and a direction that is held is never corrected.
std::array<MatchDirection, 6> Registration::glimpse(const Pose& pose, double scale) const {
  const auto look = [&](std::size_t step) {
    const std::vector<PlaneRow> rows = unweightedRows(pose, scale, step);
    return DirectionObserver(rows, settings_.normal_noise_rad).directions();
  };
  const std::size_t step = std::max<std::size_t>(matched_.size() / kGlimpse, 1);
  const std::array<MatchDirection, 6> observed = look(step);
  return allFull(observed) || step == 1 ? observed : look(1);
}

MotionProbe::Answer Registration::probe(const Motion& motion) const {
  return MotionProbe(planes_, matches_, result_.pose, result_.scale, result_.gate, arena_)
      .ask(motion);
}

void Registration::summarize(double scale, Alignment& alignment) {
  alignment.near = near_;
  alignment.matched = static_cast<int>(matched_.size());
  if (matched_.empty()) return;
  double squares = 0;
  scratch_.clear();
  for (std::size_t k = 0; k < lanes_.size(); ++k) {
    const float residual_sq = lanes_.residual(k) * lanes_.residual(k);
    scratch_.push_back(residual_sq);
    if (static_cast<double>(residual_sq) >
        kInlier * kInlier * scale * scale * static_cast<double>(lanes_.variance(k)))
      continue;
    ++alignment.inliers;
    squares += static_cast<double>(residual_sq);
  }
  if (alignment.inliers > 0) alignment.residual_rms_m = std::sqrt(squares / alignment.inliers);
  alignment.residual_median_m = std::sqrt(static_cast<double>(medianOf(scratch_)));
}

// Steps of robust least squares on part of the points at first, on all of them later; the errors
// that points share are no part of it.
Alignment Registration::align(const Pose& start, const AlignSchedule& schedule) {
  Alignment alignment;
  Pose& pose = alignment.T_local_body;
  pose = start;
  Anchors anchors;
  bool rough = true, look = true, weak = false;
  double scale = 1, widening = 0;
  rows_.clear();
  matches_.resize(planes_.size());
  ++alignments_;
  association_ = {};
  const std::size_t coarse = std::max<std::size_t>(planes_.size() / kCoarsePoints, 1);
  for (int i = 0; i < schedule.max_iterations && !alignment.converged; ++i) {
    {
      const AddTime time(alignment.timing.association_s);
      const double gate = gateAt(i, schedule, widening);
      const std::size_t stride = rough ? coarse : 1;
      if (!rough && holdsAt(pose, gate, stride)) {
        lanes_.moveTo(pose);
      } else {
        associate(pose, gate, i, stride);
      }
    }
    alignment.iterations = i + 1;
    if (matched_.size() < kMinRows) break;
    const AddTime time(alignment.timing.solve_s);
    scale = robustScale(kScaleSample);
    if (look && settings_.degeneracy_handling) {
      const std::array<MatchDirection, 6> observed = glimpse(pose, scale);
      if (!weak && !allFull(observed)) widening = schedule.start_sigma_m;
      weak = weak || !allFull(observed);
      anchors.hold(observed);
    }
    NormalEquations system = lanes_.equations(kKernel, scale, widening, arena_);
    anchors.addTo(system, differenceInBody(pose, start));
    Vec6 step;
    if (!solveStep(system, step)) break;
    const double position = step.head<3>().norm(), rotation = step.tail<3>().norm();
    alignment.converged =
        !rough && widening == 0 && position < kConvergedM && rotation < kConvergedRad;
    pose = movedInBody(pose, step);
    if (i + 1 >= schedule.first_iterations) widening = narrowed(widening);
    // The directions are looked at once with few points and the wide gate, once with all.
    const bool near = position < kNearM && rotation < kNearRad;
    const bool was_rough =
        std::exchange(rough, widening == 0 && (i + 1 < schedule.first_iterations ||
                                               (rough && coarse > 1 && !near &&
                                                i + 1 < schedule.first_iterations + kMoreRough)));
    look = was_rough && !rough;
  }
  // The last step is so small that the planes hold after it, too.
  if (alignment.converged) {
    lanes_.moveTo(pose);
  } else {
    associate(pose, schedule.gate_m, alignment.iterations, 1);
  }
  result_ = {pose, scale, association_.gate};
  fillRows(pose, scale);
  summarize(scale, alignment);
  return alignment;
}

}  // namespace paloc
