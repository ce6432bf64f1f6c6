#pragma once

#include <variant>
#include <vector>

#include "paloc/core/bias_walk_factor.h"
#include "paloc/core/constant_gravity_factor.h"
#include "paloc/core/gravity_factor.h"
#include "paloc/core/imu_factor.h"
#include "paloc/core/lidar_odometry_factor.h"
#include "paloc/core/map_factor.h"
#include "paloc/core/no_motion_factor.h"
#include "paloc/core/prior_factor.h"
#include "paloc/core/velocity_factor.h"
#include "paloc/core/zero_velocity_factor.h"

namespace paloc {

/// A factor on one node.
using NodeFactor = std::variant<PriorFactor, MapFactor, ZeroVelocityFactor, GravityFactor>;

/// A factor between a node and the one before it.
using EdgeFactor = std::variant<LidarOdometryFactor, ImuFactor, BiasWalkFactor,
                                ConstantGravityFactor, NoMotionFactor, VelocityFactor>;

/// A node of the chain of states, with the factors on it and those to the node before it. Any mix
/// of factors will do, and any may be missing.
struct ChainNode {
  TimeNs t_ns = 0;
  State state;  ///< the linearization point
  std::vector<NodeFactor> node_factors;
  std::vector<EdgeFactor> edge_factors;  ///< from the node before; empty at the first
};

/// What the factors of one node add to the normal equations H delta = b, at their linearization
/// points: for the node itself (j) and for the one before it (i).
struct PALOC_EXPORT ChainBlock {
  StateMatrix hessian_jj = StateMatrix::Zero();  ///< of the node's own factors and of its edge
  StateMatrix hessian_ji = StateMatrix::Zero();  ///< of the edge: rows j, columns i
  StateMatrix hessian_ii = StateMatrix::Zero();  ///< of the edge
  StateVector b_j = StateVector::Zero();
  StateVector b_i = StateVector::Zero();
  double cost = 0;  ///< of the node's factors and its edge's, robust, whitened; 1

  /// False if something is not finite, or surer than any measurement can be.
  bool usable() const;
};

/// Linearizes the factors of `node` and those of its edge from `previous` (null at the first node).
PALOC_EXPORT ChainBlock linearize(const ChainNode* previous, const ChainNode& node);

/// Only the part of the edge (b, hessian_ii, hessian_ji, hessian_jj without the node's own
/// factors).
PALOC_EXPORT ChainBlock linearizeEdge(const ChainNode& previous, const ChainNode& node);

}  // namespace paloc
