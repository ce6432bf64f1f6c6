#include "paloc/tools/trajectory_error.h"

#include <algorithm>
#include <cmath>

#include "paloc/core/so3.h"

namespace paloc {
namespace {

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

std::vector<TimeNs> stampsOf(const std::vector<MatchedPose>& matched) {
  std::vector<TimeNs> stamps;
  stamps.reserve(matched.size());
  for (const MatchedPose& pair : matched) stamps.push_back(pair.t_ns);
  return stamps;
}

std::vector<std::size_t> indicesByFrames(std::size_t poses, double delta) {
  const auto step = static_cast<std::size_t>(std::llround(delta));
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; step > 0 && i < poses; i += step) indices.push_back(i);
  return indices;
}

std::vector<std::size_t> indicesByPath(const std::vector<MatchedPose>& matched, double delta_m) {
  std::vector<std::size_t> indices;
  double path_m = 0;
  for (std::size_t i = 1; i < matched.size(); ++i) {
    path_m += (matched[i].estimate.position - matched[i - 1].estimate.position).norm();
    if (path_m < delta_m) continue;
    indices.push_back(i);
    path_m = 0;
  }
  return indices;
}

// The pose nearest to `t_ns`, of those after `from`.
std::size_t nearestAfter(const std::vector<MatchedPose>& matched, std::size_t from, TimeNs t_ns) {
  std::size_t i = from + 1;
  while (i + 1 < matched.size() &&
         std::abs(matched[i + 1].t_ns - t_ns) < std::abs(matched[i].t_ns - t_ns)) {
    ++i;
  }
  return i;
}

std::vector<std::size_t> indicesByTime(const std::vector<MatchedPose>& matched, double delta_s) {
  std::vector<std::size_t> indices;
  if (matched.empty()) return indices;
  indices.push_back(0);
  const TimeNs delta_ns = nsFromSeconds(delta_s);
  // The last pair may end half a step early: stamps jitter.
  const TimeNs end_ns = matched.back().t_ns + nsFromSeconds(0.5 * medianStep(stampsOf(matched)));
  while (indices.back() + 1 < matched.size() && matched[indices.back()].t_ns + delta_ns <= end_ns) {
    const std::size_t i = indices.back();
    indices.push_back(nearestAfter(matched, i, matched[i].t_ns + delta_ns));
  }
  return indices;
}

// gaps_before[i]: the gaps between pose 0 and pose i.
std::vector<std::size_t> countGaps(const std::vector<MatchedPose>& matched, double max_gap_s) {
  std::vector<std::size_t> gaps_before(matched.size(), 0);
  for (std::size_t i = 1; i < matched.size(); ++i) {
    const bool gap = secondsBetween(matched[i - 1].t_ns, matched[i].t_ns) > max_gap_s;
    gaps_before[i] = gaps_before[i - 1] + (gap ? 1 : 0);
  }
  return gaps_before;
}

Pose relativeMotion(const Pose& from, const Pose& to) { return from.inverse() * to; }

}  // namespace

std::string toString(DeltaUnit unit) {
  switch (unit) {
    case DeltaUnit::kFrames:
      return "frames";
    case DeltaUnit::kMetres:
      return "m";
    case DeltaUnit::kSeconds:
      return "s";
  }
  return "unknown";
}

AbsoluteError absoluteError(const std::vector<MatchedPose>& matched) {
  AbsoluteError result;
  std::vector<double> translation, rotation;
  double worst = -1;
  for (const MatchedPose& pair : matched) {
    translation.push_back((pair.estimate.position - pair.reference.position).norm());
    rotation.push_back(
        so3::log(pair.estimate.rotation.transpose() * pair.reference.rotation).norm());
    if (translation.back() > worst) {
      worst = translation.back();
      result.worst_ns = pair.t_ns;
    }
  }
  result.translation_m = errorStatistics(std::move(translation));
  result.rotation_rad = errorStatistics(std::move(rotation));
  return result;
}

double defaultMaxGap(const std::vector<MatchedPose>& matched, DeltaUnit unit) {
  const double missing_one_s = 1.5 * medianStep(stampsOf(matched));
  return unit == DeltaUnit::kFrames ? missing_one_s : std::max(missing_one_s, 0.5);
}

IndexPairs consecutivePairs(const std::vector<MatchedPose>& matched, double delta, DeltaUnit unit) {
  std::vector<std::size_t> indices;
  switch (unit) {
    case DeltaUnit::kFrames:
      indices = indicesByFrames(matched.size(), delta);
      break;
    case DeltaUnit::kMetres:
      indices = indicesByPath(matched, delta);
      break;
    case DeltaUnit::kSeconds:
      indices = indicesByTime(matched, delta);
      break;
  }
  IndexPairs pairs;
  for (std::size_t k = 1; k < indices.size(); ++k) pairs.emplace_back(indices[k - 1], indices[k]);
  return pairs;
}

RelativeError relativeError(const std::vector<MatchedPose>& matched,
                            const RelativeErrorSettings& settings) {
  RelativeError result;
  result.max_gap_s =
      settings.max_gap_s > 0 ? settings.max_gap_s : defaultMaxGap(matched, settings.unit);
  const std::vector<std::size_t> gaps_before = countGaps(matched, result.max_gap_s);
  std::vector<double> translation, rotation;
  for (const auto& [i, j] : consecutivePairs(matched, settings.delta, settings.unit)) {
    const bool across_gap = gaps_before[j] > gaps_before[i];
    if (across_gap) ++result.pairs_across_gaps;
    if (across_gap && !settings.across_gaps) continue;
    const Pose error = relativeMotion(relativeMotion(matched[i].reference, matched[j].reference),
                                      relativeMotion(matched[i].estimate, matched[j].estimate));
    translation.push_back(error.position.norm());
    rotation.push_back(so3::log(error.rotation).norm());
  }
  result.translation_m = errorStatistics(std::move(translation));
  result.rotation_rad = errorStatistics(std::move(rotation));
  return result;
}

}  // namespace paloc
