#pragma once

#include "paloc/core/start_guess.h"
#include "paloc/map/matcher_settings.h"
#include "start_finder.h"

namespace paloc {

/// Up in the body frame as the guess's pose has it (unit vector); without a pose the body is level.
Vec3 upOf(const StartGuess& guess);

/// The rough pose of a guess (it must have one), with the tilt that gravity tells where that is
/// known.
Pose levelled(const StartGuess& guess);

/// The region that a guess leaves to be searched. `origin` is the map's local one (m, map frame);
/// `everywhere` the box of the whole map.
StartRegion startRegion(const StartGuess& guess, const Vec3& origin, const SearchBox& everywhere,
                        const MatcherSettings& settings);

}  // namespace paloc
