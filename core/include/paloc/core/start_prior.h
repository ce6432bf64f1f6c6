#pragma once

#include "paloc/core/chain.h"
#include "paloc/core/estimator_settings.h"
#include "paloc/core/prior_factor.h"

namespace paloc {

/// What is known of the first node before any measurement: nothing of its pose (the map factor
/// tells it), and of velocity, biases and gravity what the settings say. Gravity's direction and
/// its length have standard deviations of their own.
PALOC_EXPORT PriorFactor startPrior(const State& first, const EstimatorSettings& settings);

/// The node that begins a window: what came before is not known to it, but for the biases.
PALOC_EXPORT ChainNode withoutPast(ChainNode node, const EstimatorSettings& settings);

}  // namespace paloc
