#include "motion_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "parallel_chunks.h"

namespace paloc {
namespace {

// How far the points are moved, and how many standard deviations the sum of changes must be then.
// Near the pose, planes sought anew are noise for the most part.
struct Probe {
  double by_m, significant;
};
constexpr std::array kProbes = {Probe{0.03, 1}, Probe{0.06, 2}, Probe{0.1, 2}, Probe{0.15, 2}};
constexpr double kClearlyBetter = 2;
constexpr double kKernel = 3;      // as that of the registration
constexpr double kSeesMotion = 1;  // in sigmas: what moves a residual by less says nothing

double robust(double z) { return z * z / (1 + z * z / (kKernel * kKernel)); }

// Of the points, the root mean square of how far the motion moves them.
double lengthOf(const Motion& motion, const PlaneSearch& planes) {
  double sum = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    sum += (motion.v + motion.w.cross(planes.point(i))).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(planes.size(), 1)));
}

Pose movedBy(const Pose& pose, const Motion& motion) {
  return {pose.position + pose.rotation * motion.v, pose.rotation * so3::exp(motion.w)};
}

}  // namespace

MotionProbe::Change MotionProbe::changeOf(std::size_t begin, std::size_t end, const Motion& moved,
                                          const Pose& pose) const {
  std::array<Correspondence, PlaneSearch::kMost> there;
  std::array<Correspondence*, PlaneSearch::kMost> sought{};
  for (std::size_t i = begin; i < end; ++i) {
    there[i - begin] = matches_[i];
    there[i - begin].searched_at = pose * planes_.point(i);
    sought[i - begin] = &there[i - begin];
  }
  planes_.search(std::span(sought).first(end - begin), pose, within_m_);
  Change change;
  for (std::size_t i = begin; i < end; ++i) {
    const Correspondence& here = matches_[i];
    Correspondence& match = there[i - begin];
    const bool here_planar = here.planar && here.near && here.distance <= within_m_;
    if (!here_planar || !match.planar) continue;
    planes_.measure(match, i, match.searched_at, pose.rotation);
    const Vec3 m = pose.rotation * (moved.v + moved.w.cross(planes_.point(i)));
    const double sigma = scale_ * std::min(here.sigma, match.sigma);
    const double seen = std::max(std::abs(here.normal.dot(m)), std::abs(match.normal.dot(m)));
    if (seen < kSeesMotion * sigma) continue;
    const double worse = robust(match.residual / (scale_ * match.sigma)) -
                         robust(here.residual / (scale_ * here.sigma));
    change.sum += worse;
    change.squares += worse * worse;
  }
  return change;
}

MotionProbe::Change MotionProbe::changeBy(const Motion& moved, const Pose& pose) const {
  std::vector<Change> parts(chunkCount(planes_.size(), PlaneSearch::kMost));
  forEachChunk(arena_, planes_.size(), PlaneSearch::kMost,
               [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                 parts[chunk] = changeOf(begin, end, moved, pose);
               });
  Change all;
  for (const Change& part : parts) {
    all.sum += part.sum;
    all.squares += part.squares;
  }
  return all;
}

MotionProbe::Answer MotionProbe::ask(const Motion& motion) const {
  const double length = lengthOf(motion, planes_);
  Answer answer{std::numeric_limits<double>::infinity(), {}};
  double least = -kClearlyBetter;
  for (const Probe& probe : kProbes) {
    for (const double by : {probe.by_m / length, -probe.by_m / length}) {
      const Motion moved{by * motion.v, by * motion.w};
      const Pose pose = movedBy(pose_, moved);
      const double significance = changeBy(moved, pose).significance();
      answer.clearness = std::min(answer.clearness, significance / probe.significant);
      if (significance < least) {
        least = significance;
        answer.better = pose;
      }
    }
  }
  return answer;
}

}  // namespace paloc
