#include "motion_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "parallel_chunks.h"

namespace paloc {
namespace {

// How far the points are moved. Nearer, planes sought anew are noise for the most part.
constexpr std::array kProbesM = {0.06, 0.1, 0.15};
constexpr double kClearly = 25, kBeyondDoubt = 100;  // twice the logarithm of likelihoods
constexpr std::size_t kMostPoints = 400;
constexpr double kKernel = 3;  // as that of the registration

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

// Those points that so long a motion moves off their planes by more than their noise, by most
// first; no more than some.
std::vector<MotionProbe::Seeing> MotionProbe::pointsThatSee(const Motion& motion,
                                                            double length) const {
  std::vector<Seeing> seeing;
  for (std::size_t i = 0; i < matches_.size(); ++i) {
    const Correspondence& match = matches_[i];
    if (!match.planar || !match.near || match.distance > within_m_) continue;
    const Vec3 m = pose_.rotation * (motion.v + motion.w.cross(planes_.point(i)));
    const double sigmas = std::abs(match.normal.dot(m)) / (scale_ * match.sigma);
    if (length * sigmas > 1) seeing.push_back({sigmas, static_cast<std::uint32_t>(i)});
  }
  const std::size_t count = std::min(seeing.size(), kMostPoints);
  std::partial_sort(seeing.begin(), seeing.begin() + static_cast<std::ptrdiff_t>(count),
                    seeing.end(), [](const Seeing& a, const Seeing& b) {
                      return a.sigmas > b.sigmas || (a.sigmas == b.sigmas && a.point < b.point);
                    });
  seeing.resize(count);
  return seeing;
}

double MotionProbe::changeOf(std::span<const Seeing> points, const Pose& pose) const {
  std::array<Correspondence, PlaneSearch::kMost> there;
  std::array<Correspondence*, PlaneSearch::kMost> sought{};
  for (std::size_t k = 0; k < points.size(); ++k) {
    there[k] = matches_[points[k].point];
    there[k].searched_at = pose * planes_.point(points[k].point);
    sought[k] = &there[k];
  }
  planes_.search(std::span(sought).first(points.size()), pose, within_m_);
  double change = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Correspondence& here = matches_[points[k].point];
    change -= robust(here.residual / (scale_ * here.sigma));
    if (there[k].planar) {
      planes_.measure(there[k], points[k].point, there[k].searched_at, pose.rotation);
      change += robust(there[k].residual / (scale_ * there[k].sigma));
    } else {
      change += kKernel * kKernel;  // as one that lies off every plane
    }
  }
  return change;
}

double MotionProbe::changeAt(const Pose& pose, std::span<const Seeing> points) const {
  std::vector<double> parts(chunkCount(points.size(), PlaneSearch::kMost));
  forEachChunk(arena_, points.size(), PlaneSearch::kMost,
               [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                 parts[chunk] = changeOf(points.subspan(begin, end - begin), pose);
               });
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

MotionProbe::Answer MotionProbe::ask(const Motion& motion) const {
  const double length = lengthOf(motion, planes_);
  Answer answer{std::numeric_limits<double>::infinity(), {}};
  double least = -kClearly;
  const std::vector<Seeing> all = pointsThatSee(motion, kProbesM.back() / length);
  for (const double probe_m : kProbesM) {
    double nearer = std::numeric_limits<double>::infinity();
    const auto blind = std::find_if(all.begin(), all.end(), [&](const Seeing& point) {
      return probe_m / length * point.sigmas <= 1;
    });
    const std::span seeing(all.begin(), blind);
    for (const double by : {probe_m / length, -probe_m / length}) {
      const Pose pose = movedBy(pose_, {by * motion.v, by * motion.w});
      const double worse = changeAt(pose, seeing);
      nearer = std::min(nearer, worse);
      answer.clearness = std::min(answer.clearness, worse / kClearly);
      if (worse >= least) continue;
      least = worse;
      answer.better = pose;
    }
    if (nearer > kBeyondDoubt) break;
  }
  return answer;
}

}  // namespace paloc
