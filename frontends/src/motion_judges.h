#pragma once

#include <string>

#include "paloc/frontends/finding.h"
#include "paloc/frontends/motion_comparison.h"

// What a comparison of motions says of a sensor set-up, one question each.
namespace paloc {

void judgeAgreement(const MotionComparison& motion, Findings& findings);
void judgeGyroUnit(const MotionComparison& motion, Findings& findings);
void judgeExtrinsics(const MotionComparison& motion, Findings& findings);
void judgeClockOffset(const MotionComparison& motion, Findings& findings);

/// "the LiDAR 'lidar'"
std::string nameOf(const MotionComparison& motion);
Finding findingOf(const MotionComparison& motion, const std::string& check, Severity severity);

}  // namespace paloc
