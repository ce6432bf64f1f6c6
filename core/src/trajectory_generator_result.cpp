#include "paloc/core/pose_flags.h"
#include "paloc/core/trajectory_generator.h"

// What the trajectory generator gives out, on the way and at the end.
namespace paloc {

std::vector<TrajectoryPoint> TrajectoryGenerator::takeOnline() {
  if (start_.pending()) return {};
  const auto from = online_.begin() + static_cast<std::ptrdiff_t>(online_taken_);
  online_taken_ = online_.size();
  return {from, online_.end()};
}

const FrameDiagnostics* TrajectoryGenerator::lastFrame() const {
  return diagnostics_.empty() ? nullptr : &diagnostics_.back();
}

std::optional<NodeEstimate> TrajectoryGenerator::newest() const {
  if (history_.empty()) return std::nullopt;
  return smoother_.newest();
}

Result TrajectoryGenerator::finish(Smoothing smoothing) {
  if (start_.pending() && !start_.confirmedEnough()) dropStart();
  collect(smoother_.window(true));
  setFlags(online_);
  Result result;
  if (smoothing == Smoothing::kBatch) {
    smoothRecording(settings_, *matcher_, timer_, history_, result);
  }
  if (result.trajectory.empty() && !online_.empty()) {
    result.batch_failed = smoothing == Smoothing::kBatch;
    result.trajectory = online_;
  } else {
    setFlags(result.trajectory);  // by the associations as they are now
  }
  result.online = online_;
  result.diagnostics = diagnostics_;
  result.repairs = repairsSoFar();
  result.frames_before_start =
      history_.empty() ? diagnostics_.size() : history_[0].diagnostics_index;
  if (result.trajectory.empty()) {
    result.no_trajectory_reason =
        diagnostics_.empty() ? "the recording gave no odometry frame: no scan could be used"
                             : start_.reason();
  }
  return result;
}

void TrajectoryGenerator::setFlags(std::vector<TrajectoryPoint>& points) const {
  std::vector<bool> has_map_factor;
  for (const HistoryNode& entry : history_) {
    has_map_factor.push_back(entry.association.match.accepted());
  }
  setPoseFlags(has_map_factor, settings_, points);
}

}  // namespace paloc
