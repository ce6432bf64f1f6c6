#pragma once

#include <array>
#include <span>

#include "paloc/core/pose.h"

namespace paloc {

/// A point of a scan where a ray truly meets its surface, with the surface's true normal.
struct ExactPoint {
  Vec3 position_body = Vec3::Zero();  ///< m
  Vec3 normal_body = Vec3::Zero();    ///< unit
};

/// What the geometry of a place can tell of one direction, whatever a detector says.
enum class DirectionLabel {
  kFull,        ///< known to a fifth of the degenerate bound or better
  kWeak,        ///< in between: neither verdict on it is counted
  kDegenerate,  ///< the geometry leaves it open, or known worse than the bound
};

/// Bounds on the standard deviation that white noise alone would leave, above which a direction is
/// degenerate.
inline constexpr double kDegenerateSigmaM = 0.05;
inline constexpr double kDegenerateSigmaRad = 0.0087;  // 0.5 degrees

/// The six directions of a pose as the exact geometry fixes them.
struct LabelledDirections {
  std::array<Vec3, 6> axis_body{};  ///< 0..2 position, 3..5 rotation; the weakest first of each
  std::array<double, 6> sigma{};    ///< m or rad, infinite where nothing fixes the direction
  std::array<DirectionLabel, 6> label{};
};

/// Labels the directions of a pose by the point-to-plane Hessian of exact points and exact normals,
/// H = sum J^T J / sigma^2 with J = [n, p x n] and the white range noise of the data sheet: along
/// the eigenvectors of its Schur complements S_t = H_tt - H_tR H_RR^+ H_Rt and S_R likewise the
/// standard deviation that could be achieved at best is 1/sqrt(eigenvalue). No threshold of the
/// detector enters.
LabelledDirections labelDirections(std::span<const ExactPoint> points, double range_noise_m);

}  // namespace paloc
