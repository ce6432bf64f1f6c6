#include "paloc/core/fixed_lag_smoother.h"

#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

bool finite(const State& x) {
  return x.T_map_body.position.allFinite() && x.T_map_body.rotation.allFinite() &&
         x.v_map.allFinite() && x.bias_acc.allFinite() && x.bias_gyro.allFinite() &&
         x.gravity_map.allFinite();
}

// What a platform on the ground may be expected to be near at all.
StateVector wideSigma() {
  StateVector sigma;
  sigma << Vec3::Constant(10), Vec3::Constant(1), Vec3::Constant(10), Vec3::Constant(0.5),
      Vec3::Constant(0.05), Vec3::Constant(0.1);
  return sigma;
}

// The anchor of last resort.
PriorFactor wideAnchor(const State& state) { return PriorFactor::fromSigmas(state, wideSigma()); }

UpdateSummary refused() {
  UpdateSummary summary;
  summary.status = UpdateSummary::Status::kRefused;
  return summary;
}

}  // namespace

FixedLagSmoother::FixedLagSmoother(const SmootherSettings& settings) : settings_(settings) {}

UpdateSummary FixedLagSmoother::add(ChainNode node) {
  if (!finite(node.state) || (!nodes_.empty() && node.t_ns <= nodes_.back().t_ns)) return refused();
  const std::uint64_t dropped_before = repairs_.factors_dropped;
  const ChainNode* previous = nodes_.empty() ? nullptr : &nodes_.back();
  blocks_.push_back(usableBlock(previous, node));
  nodes_.push_back(std::move(node));
  ids_.push_back(next_id_++);
  delta_.push_back(StateVector::Zero());
  solver_.append();
  UpdateSummary summary = update(nodes_.size() < 2 ? 0 : nodes_.size() - 2);
  if (repairs_.factors_dropped != dropped_before) summary.status = UpdateSummary::Status::kRepaired;
  const TimeNs lag_ns = nsFromSeconds(settings_.lag_s);
  while (nodes_.size() > 2 && nodes_.back().t_ns - nodes_.front().t_ns > lag_ns) {
    marginalizeOldest();
  }
  return summary;
}

UpdateSummary FixedLagSmoother::addFactor(NodeId id, NodeFactor factor) {
  const auto found = std::find(ids_.begin(), ids_.end(), id);
  if (found == ids_.end()) {
    refused_as_too_old_ += id < next_id_ ? 1 : 0;
    return refused();
  }
  const auto k = static_cast<std::size_t>(found - ids_.begin());
  nodes_[k].node_factors.push_back(std::move(factor));
  ChainBlock block = linearize(k == 0 ? nullptr : &nodes_[k - 1], nodes_[k]);
  if (!block.usable()) {
    nodes_[k].node_factors.pop_back();
    ++repairs_.factors_dropped;
    return refused();
  }
  blocks_[k] = block;
  return update(k);
}

UpdateSummary FixedLagSmoother::insert(ChainNode node, std::vector<EdgeFactor> edge_to_next) {
  if (!finite(node.state) || nodes_.empty() || node.t_ns >= nodes_.back().t_ns) return refused();
  if (node.t_ns < nodes_.front().t_ns) {
    ++refused_as_too_old_;
    return refused();
  }
  const auto next =
      std::upper_bound(nodes_.begin(), nodes_.end(), node.t_ns,
                       [](TimeNs t, const ChainNode& other) { return t < other.t_ns; });
  const auto k = next - nodes_.begin();  // at least 1: the front is not after it
  const auto place = static_cast<std::size_t>(k);
  if (nodes_[place - 1].t_ns == node.t_ns) return refused();

  const std::uint64_t dropped_before = repairs_.factors_dropped;
  blocks_.insert(blocks_.begin() + k, usableBlock(&nodes_[place - 1], node));
  nodes_.insert(next, std::move(node));
  nodes_[place + 1].edge_factors = std::move(edge_to_next);
  blocks_[place + 1] = usableBlock(&nodes_[place], nodes_[place + 1]);
  ids_.insert(ids_.begin() + k, next_id_++);
  delta_.insert(delta_.begin() + k, StateVector::Zero());
  solver_.append();  // the blocks from here on move up by one
  UpdateSummary summary = update(place - 1);
  if (repairs_.factors_dropped != dropped_before) summary.status = UpdateSummary::Status::kRepaired;
  return summary;
}

// The block of a node, after factors that cannot be used have been dropped from it.
ChainBlock FixedLagSmoother::usableBlock(const ChainNode* previous, ChainNode& node) {
  ChainBlock block = linearize(previous, node);
  if (block.usable()) return block;
  dropUnusableFactors(node, previous);
  return linearize(previous, node);
}

UpdateSummary FixedLagSmoother::update(std::size_t first_changed) {
  UpdateSummary summary;
  summary.factorized_from = first_changed;
  for (int round = 0;; ++round) {
    assembleFrom(first_changed);
    if (!factorize(first_changed, summary)) return summary;
    solver_.solve(delta_);
    if (round >= settings_.max_relinearizations) break;
    first_changed = relinearizeMoved(summary);
    if (first_changed == nodes_.size()) break;
    summary.factorized_from = std::min(summary.factorized_from, first_changed);
  }
  return summary;
}

bool FixedLagSmoother::mustRelinearize(const StateVector& delta) const {
  using namespace tangent;
  const auto beyond = [&](int offset, double threshold) {
    return delta.segment<3>(offset).squaredNorm() > threshold * threshold;
  };
  return beyond(kPosition, settings_.relinearize_position_m) ||
         beyond(kRotation, settings_.relinearize_rotation_rad) ||
         beyond(kVelocity, settings_.relinearize_velocity_mps) ||
         beyond(kBiasAcc, settings_.relinearize_bias_acc_mps2) ||
         beyond(kBiasGyro, settings_.relinearize_bias_gyro_radps) ||
         beyond(kGravity, settings_.relinearize_gravity);
}

// Moves the linearization points of nodes that have drifted from them; returns the oldest block
// that changed by it, or the number of nodes if none did.
std::size_t FixedLagSmoother::relinearizeMoved(UpdateSummary& summary) {
  std::vector<bool> moved(nodes_.size(), false);
  std::size_t first = nodes_.size();
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    if (!mustRelinearize(delta_[k])) continue;
    nodes_[k].state = estimate(k);
    nodes_[k].state.T_map_body.rotation = so3::normalized(nodes_[k].state.T_map_body.rotation);
    delta_[k].setZero();
    moved[k] = true;
    first = k;
    ++summary.relinearized;
  }
  if (first == nodes_.size()) return first;
  relinearizeBlocks(moved);
  return first == 0 ? 0 : first - 1;  // the edge to the block before changed as well
}

void FixedLagSmoother::relinearizeBlocks(const std::vector<bool>& moved) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if (moved[k] || (k > 0 && moved[k - 1])) {
      blocks_[k] = linearize(k == 0 ? nullptr : &nodes_[k - 1], nodes_[k]);
    }
  }
}

void FixedLagSmoother::assembleFrom(std::size_t first) {
  for (std::size_t k = first; k < nodes_.size(); ++k) {
    StateMatrix diagonal = blocks_[k].hessian_jj;
    StateVector b = blocks_[k].b_j;
    if (k + 1 < nodes_.size()) {
      diagonal += blocks_[k + 1].hessian_ii;
      b += blocks_[k + 1].b_i;
    }
    solver_.set(k, diagonal, blocks_[k].hessian_ji, b);
  }
}

bool FixedLagSmoother::factorize(std::size_t first, UpdateSummary& summary) {
  for (int attempt = 0; attempt < 3; ++attempt) {
    const std::size_t failed = solver_.factorizeFrom(first);
    if (failed == nodes_.size()) return true;
    // A direction that nothing holds: hold it where it is, loosely, and say so.
    summary.status = UpdateSummary::Status::kRepaired;
    ++repairs_.damped;
    nodes_[failed].node_factors.push_back(wideAnchor(nodes_[failed].state));
    blocks_[failed] = linearize(failed == 0 ? nullptr : &nodes_[failed - 1], nodes_[failed]);
    first = std::min(first, failed);
    assembleFrom(first);
  }
  reanchor(summary);
  return false;
}

// Starts the window anew from the newest node, where the estimate last stood. Without a
// factorization nothing can be told of how sure the others are: they leave as unsure as the anchor.
void FixedLagSmoother::reanchor(UpdateSummary& summary) {
  summary.status = UpdateSummary::Status::kRepaired;
  ++repairs_.reanchored;
  ChainNode newest = nodes_.back();
  const StateMatrix unsure = wideSigma().cwiseAbs2().asDiagonal();
  for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
    left_.push_back({ids_[k], nodes_[k].t_ns, estimate(k), unsure});
  }
  ids_.assign(1, NodeId(ids_.back()));
  newest.edge_factors.clear();
  newest.node_factors.assign(1, wideAnchor(newest.state));
  nodes_.assign(1, newest);
  blocks_.assign(1, linearize(nullptr, newest));
  delta_.assign(1, StateVector::Zero());
  solver_.clear();
  solver_.append();
  assembleFrom(0);
  solver_.factorizeFrom(0);
}

void FixedLagSmoother::dropUnusableFactors(ChainNode& node, const ChainNode* previous) {
  ChainNode probe;
  probe.t_ns = node.t_ns;
  probe.state = node.state;
  std::erase_if(node.node_factors, [&](const NodeFactor& factor) {
    probe.node_factors.assign(1, factor);
    const bool bad = !linearize(nullptr, probe).usable();
    repairs_.factors_dropped += bad ? 1 : 0;
    return bad;
  });
  probe.node_factors.clear();
  std::erase_if(node.edge_factors, [&](const EdgeFactor& factor) {
    probe.edge_factors.assign(1, factor);
    const bool bad = previous && !linearizeEdge(*previous, probe).usable();
    repairs_.factors_dropped += bad ? 1 : 0;
    return bad;
  });
}

void FixedLagSmoother::marginalizeOldest() {
  NodeEstimate left{ids_.front(), nodes_[0].t_ns, estimate(0), StateMatrix::Zero()};
  if (settings_.covariance_of_leaving) left.covariance = solver_.covariance(0);
  left_.push_back(left);

  // What the oldest node and its edge say of the next one becomes a prior there, at that node's
  // linearization point. The factor L of the others stays what it is.
  StateMatrix information;
  StateVector b;
  solver_.eliminationOfFront(information, b);
  const ChainBlock edge = linearizeEdge(nodes_[0], nodes_[1]);
  nodes_[1].node_factors.push_back(
      PriorFactor(nodes_[1].state, edge.hessian_jj + information, edge.b_j + b));
  nodes_[1].edge_factors.clear();
  nodes_.pop_front();
  blocks_.pop_front();
  delta_.erase(delta_.begin());
  ids_.pop_front();
  solver_.dropFront();
  // With the edge gone and the prior in its place, the node's own share is what it was and the
  // elimination.
  blocks_[0].hessian_jj += information;
  blocks_[0].b_j += b;
  blocks_[0].hessian_ji.setZero();
  blocks_[0].hessian_ii.setZero();
  blocks_[0].b_i.setZero();
  StateMatrix diagonal = blocks_[0].hessian_jj;
  StateVector b_front = blocks_[0].b_j;
  if (nodes_.size() > 1) {
    diagonal += blocks_[1].hessian_ii;
    b_front += blocks_[1].b_i;
  }
  solver_.set(0, diagonal, StateMatrix::Zero(), b_front);
}

NodeEstimate FixedLagSmoother::newest() const {
  return {newestId(), nodes_.back().t_ns, estimate(nodes_.size() - 1), solver_.newestCovariance()};
}

std::vector<NodeEstimate> FixedLagSmoother::window(bool with_covariances) const {
  std::vector<StateMatrix> covariances;
  if (with_covariances) covariances = solver_.covariances();
  std::vector<NodeEstimate> result;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    result.push_back({ids_[k], nodes_[k].t_ns, estimate(k),
                      with_covariances ? covariances[k] : StateMatrix::Zero()});
  }
  return result;
}

std::vector<NodeEstimate> FixedLagSmoother::takeLeft() {
  std::vector<NodeEstimate> result;
  result.swap(left_);
  return result;
}

}  // namespace paloc
