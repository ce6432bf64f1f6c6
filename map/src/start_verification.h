#pragma once

#include "registration.h"

namespace paloc {

/// What speaks for and against a start, at the result of an alignment.
struct StartEvidence {
  /// Of the points tried, those within 10 cm of the map's surface there. Points near a part of the
  /// map that is no surface (a bush, an edge) do not count either way.
  double explained = 0;
  double fitting = 0;  ///< the same of those only that found a surface
  double blocked = 0;  ///< of the rays, those that pass through a surface of the map

  /// By which places are compared.
  double worth() const { return explained - blocked; }
};

/// Weighs the alignment that `registration` made last. `rays`: how many are followed at most.
StartEvidence weighStart(const Registration& registration, const Alignment& alignment,
                         const PriorMap& map, std::size_t rays);

}  // namespace paloc
