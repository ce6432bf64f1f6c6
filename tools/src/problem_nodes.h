#pragma once

#include "paloc/core/chain.h"
#include "paloc/tools/smoother_problem.h"

namespace paloc {

/// The first node of a problem, node 0, with the prior that problems have: velocity as it is in
/// truth (sigma 0.1 m/s), biases zero (0.1 m/s2, 0.01 rad/s), gravity along -z (1e-4). Its pose is
/// the first map measurement's; without one, the truth's.
ChainNode firstProblemNode(const SmootherProblem::Node& first);

/// Node `k` > 0 (`source`) after the node `before`: preintegrates its IMU samples, each held until
/// the next, about the biases of `last`, the estimate of the node before it; predicts its state;
/// and makes its factors, those measurements left out that belong to older nodes.
ChainNode nextProblemNode(const ImuNoise& noise, const SmootherProblem::Node& before,
                          const SmootherProblem::Node& source, std::size_t k, const State& last);

}  // namespace paloc
