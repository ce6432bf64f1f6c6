#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "paloc/core/chain.h"
#include "paloc/core/chain_solver.h"
#include "paloc/core/smoother_settings.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// Names a node for as long as it is in the window; counts up from 0 in the order of arrival.
using NodeId = std::uint64_t;

/// An estimate of one node.
struct NodeEstimate {
  NodeId id = 0;
  TimeNs t_ns = 0;
  State state;
  StateMatrix covariance = StateMatrix::Zero();  ///< zero where it was not asked for
};

/// What became of one update.
struct UpdateSummary {
  enum class Status { kGood, kRepaired, kRefused };
  Status status = Status::kGood;
  int relinearized = 0;             ///< nodes that got a new linearization point
  std::size_t factorized_from = 0;  ///< oldest block whose factorization was redone
};

/// Incremental fixed-lag smoother of a chain of states (in the manner of iSAM2, Kaess et al. 2012,
/// on a chain): keeps the Cholesky factor of the window, appends new nodes at its end, relinearizes
/// only nodes that moved more than a threshold, refactorizes from the oldest block that changed,
/// and marginalizes by dropping the leading columns. After every update the estimate is that of a
/// full factorization of the same linearized window.
class PALOC_EXPORT FixedLagSmoother {
 public:
  explicit FixedLagSmoother(const SmootherSettings& settings);

  /// Appends a node, newer than all others, with its factors. Its state is the first guess.
  /// Factors that are not finite, or absurdly sure, are dropped and counted; a node whose state or
  /// time cannot be used is refused. Never throws for what is in the data.
  UpdateSummary add(ChainNode node);

  /// Adds a factor to a node that is still in the window (data that came late, but within the lag).
  /// Refused, and counted, if the node has left.
  UpdateSummary addFactor(NodeId id, NodeFactor factor);

  /// Puts a node that came late into its place between two nodes of the window: `node.edge_factors`
  /// lead to it from the one before, `edge_to_next` replaces the factors between the two. Refused
  /// if there is a node at its time already, or none after it; refused, and counted, if it is older
  /// than the window.
  UpdateSummary insert(ChainNode node, std::vector<EdgeFactor> edge_to_next);

  /// Nodes and factors that came when their place had left the window.
  std::uint64_t refusedAsTooOld() const { return refused_as_too_old_; }

  bool empty() const { return nodes_.empty(); }
  std::size_t size() const { return nodes_.size(); }
  NodeId newestId() const { return ids_.back(); }

  /// The newest node's estimate with its covariance.
  NodeEstimate newest() const;
  /// All nodes of the window, oldest first, with covariances if asked.
  std::vector<NodeEstimate> window(bool with_covariances) const;
  /// The nodes that left the window since the last call, as they were when they left, oldest first.
  std::vector<NodeEstimate> takeLeft();

  /// The window as it is factorized: all nodes with their factors, those that marginalization left
  /// among them, at their linearization points; oldest first. For checks.
  std::vector<ChainNode> linearizedWindow() const { return {nodes_.begin(), nodes_.end()}; }

  const RepairCounts& repairs() const { return repairs_; }

 private:
  ChainBlock usableBlock(const ChainNode* previous, ChainNode& node);
  UpdateSummary update(std::size_t first_changed);
  State estimate(std::size_t k) const { return boxplus(nodes_[k].state, delta_[k]); }
  bool mustRelinearize(const StateVector& delta) const;
  std::size_t relinearizeMoved(UpdateSummary& summary);
  void relinearizeBlocks(const std::vector<bool>& moved);
  void assembleFrom(std::size_t first);
  bool factorize(std::size_t first, UpdateSummary& summary);
  void reanchor(UpdateSummary& summary);
  void dropUnusableFactors(ChainNode& node, const ChainNode* previous);
  void marginalizeOldest();

  SmootherSettings settings_;
  NodeId next_id_ = 0;
  std::deque<NodeId> ids_;  // of the nodes; in order of time, which is not that of arrival
  std::deque<ChainNode> nodes_;
  std::deque<ChainBlock> blocks_;  // of each node, at the linearization points
  std::vector<StateVector> delta_;
  ChainSolver solver_;
  std::vector<NodeEstimate> left_;
  RepairCounts repairs_;
  std::uint64_t refused_as_too_old_ = 0;
};

}  // namespace paloc
