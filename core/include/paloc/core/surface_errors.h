#pragma once

#include <cstddef>
#include <vector>

#include "paloc/core/constant_errors.h"
#include "paloc/core/export.h"
#include "paloc/core/map_matcher.h"

namespace paloc {

/// The shifts of the map's surfaces as constant errors of a recording: a surface is shifted by the
/// same in every scan that lies on it, and by something else than the next surface. The factors
/// (mapFactorOfOneAmong()) take them, and what else is the matter with a scan, for white; what
/// varies along a surface (a thick map, sharedSpread()) is shared by as many scans as they say.
class PALOC_EXPORT SurfaceErrors {
 public:
  explicit SurfaceErrors(std::size_t nodes) : taken_as_white_(nodes, Mat6::Zero()) {}

  /// The match that gave a node, in ascending order, its map factor, one among how many scans; and
  /// what the robust kernel leaves of the factor (0..1).
  void add(std::size_t node, const MapMatch& match, double scans, double robust_weight);

  /// For considerConstantErrors().
  const std::vector<Mat6>& takenAsWhite() const { return taken_as_white_; }
  const std::vector<ConstantError>& constant() const { return constant_; }

 private:
  void addTo(std::size_t surface, std::size_t node, const Vec6& gradient);

  std::vector<Mat6> taken_as_white_;
  std::vector<ConstantError> constant_;  // by the number of the surface
};

}  // namespace paloc
