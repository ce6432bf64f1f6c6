#include "paloc/core/smooth_recording.h"

#include <algorithm>
#include <variant>

#include "paloc/core/batch_smoother.h"
#include "paloc/core/map_correlation.h"
#include "paloc/core/surface_errors.h"
#include "paloc/core/trajectory_point.h"

namespace paloc {
namespace {

// True if any association is a new one.
bool associateAllAnew(const EstimatorSettings& settings, MapMatcher& matcher,
                      const BatchSummary& batch, const std::vector<ChainNode>& nodes,
                      std::vector<HistoryNode>& history, RematchCounts& counts) {
  bool any = false;
  counts.not_kept = 0;  // the last round's are all
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Mat6 covariance = batch.covariances[k].topLeftCorner<6, 6>();
    any |= associateAnew(matcher, settings, nodes[k].state.T_map_body, covariance,
                         history[k].association, counts);
  }
  return any;
}

// The map factors of all associations, by how many scans share their errors before and after, which
// is returned.
std::vector<double> putMapFactors(const EstimatorSettings& settings,
                                  const std::vector<HistoryNode>& history,
                                  std::vector<ChainNode>& nodes) {
  std::vector<Vec3> positions;
  std::vector<bool> has_map_factor;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    positions.push_back(nodes[k].state.T_map_body.position);
    has_map_factor.push_back(history[k].association.match.accepted());
  }
  std::vector<double> scans =
      scansSharingErrors(positions, has_map_factor, settings.map_correlation_distance_m);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    std::erase_if(nodes[k].node_factors, [](const NodeFactor& factor) {
      return std::holds_alternative<MapFactor>(factor);
    });
    if (!has_map_factor[k]) continue;
    nodes[k].node_factors.push_back(
        mapFactorOfOneAmong(history[k].association.match, scans[k], settings.map_robust_width));
  }
  return scans;
}

// What the surfaces of the map were taken for in the factors gives way to what they are.
void considerSurfaces(const std::vector<HistoryNode>& history, const std::vector<ChainNode>& nodes,
                      const std::vector<double>& scans, BatchSummary& batch) {
  SurfaceErrors errors(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!history[k].association.match.accepted()) continue;
    for (const NodeFactor& factor : nodes[k].node_factors) {
      if (const auto* map = std::get_if<MapFactor>(&factor)) {
        const double square = map->linearize(nodes[k].state).residual.squaredNorm();
        const double root = map->kernel().sqrtWeight(square);
        errors.add(k, history[k].association.match, scans[k], root * root);
      }
    }
  }
  ChainSolver::JointCovariances covariances{
      std::move(batch.covariances), std::move(batch.covariances_with_next), std::move(batch.gains)};
  considerConstantErrors(errors.takenAsWhite(), errors.constant(), covariances);
  batch.covariances = std::move(covariances.own);
  batch.covariances_with_next = std::move(covariances.with_next);
}

}  // namespace

void smoothRecording(const EstimatorSettings& settings, MapMatcher& matcher, StageTimer* timer,
                     std::vector<HistoryNode>& history, Result& result) {
  StageScope stage(timer, "batch");
  std::vector<ChainNode> nodes;
  nodes.reserve(history.size());
  for (const HistoryNode& entry : history) nodes.push_back(entry.node);
  std::vector<double> scans = putMapFactors(settings, history, nodes);
  BatchSummary batch = smoothBatch(nodes, settings.smoother);
  for (int round = 0; round < settings.max_rematch_rounds; ++round) {
    if (batch.status == BatchSummary::Status::kFailed) return;
    {
      StageScope rematch(timer, "rematch");
      if (!associateAllAnew(settings, matcher, batch, nodes, history, result.rematched)) break;
    }
    scans = putMapFactors(settings, history, nodes);
    batch = smoothBatch(nodes, settings.smoother);
  }
  if (batch.status == BatchSummary::Status::kFailed) return;
  considerSurfaces(history, nodes, scans, batch);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const NodeEstimate estimate{k, nodes[k].t_ns, nodes[k].state, batch.covariances[k]};
    result.trajectory.push_back(trajectoryPoint(estimate, history[k].association.match));
  }
  result.covariances = std::move(batch.covariances);
  result.covariances_with_next = std::move(batch.covariances_with_next);
}

}  // namespace paloc
