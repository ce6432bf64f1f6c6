#pragma once

#include <string>
#include <vector>

#include "paloc/tools/trajectory_association.h"

namespace paloc {

/// How an estimate is moved onto its reference before their difference is taken.
enum class Alignment {
  kNone,    ///< not at all: the map fixes the frame, and the estimate is held to it
  kSe3,     ///< the rigid motion that leaves the least squares of position
  kYaw,     ///< likewise, but turning about the reference's z only: gravity is held to
  kOrigin,  ///< the first matched poses are made equal
};

/// The name on the command line ("none", "se3", "yaw", "origin").
std::string toString(Alignment alignment);

/// T_reference_estimate, to be applied to every pose of the estimate from the left. SE(3) after
/// Umeyama, "Least-squares estimation of transformation parameters between two point patterns"
/// (1991), without scale. Throws UsageError where the positions do not fix the answer: fewer than
/// three, all in one place, or for SE(3) all on one line.
Pose alignmentOf(const std::vector<MatchedPose>& matched, Alignment alignment);

/// The same poses, the estimate's moved by `T_reference_estimate`.
std::vector<MatchedPose> aligned(std::vector<MatchedPose> matched,
                                 const Pose& T_reference_estimate);

}  // namespace paloc
