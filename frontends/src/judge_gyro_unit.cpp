#include <cmath>
#include <numbers>

#include "motion_judges.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {

void judgeGyroUnit(const MotionComparison& motion, Findings& findings) {
  constexpr double kTolerance = 0.05, kFar = 0.2, kUnitTolerance = 0.15, kSigmas = 6;
  const double off = std::abs(motion.gyro_scale - 1);
  if (!motion.fits || off < kTolerance || off < kSigmas * motion.gyro_scale_sigma) return;
  const double reads = 1 / motion.gyro_scale;
  const std::string found =
      text("the gyroscope of the IMU '", motion.imu_label, "' reads ", figure("%.3g", reads),
           " times the turning that ", nameOf(motion), " sees: ");
  Finding finding =
      findingOf(motion, "gyro-unit", off > kFar ? Severity::kError : Severity::kWarning);
  finding.label = motion.imu_label;
  finding.value = reads;
  if (std::abs(motion.gyro_scale / (std::numbers::pi / 180) - 1) < kUnitTolerance) {
    finding.sentence =
        found + "it is in deg/s, not rad/s; multiply it by 0.0174533 before the import";
  } else {
    finding.sentence = found +
                       "its scale is wrong, or it is smoothed or clipped; look at its unit, filter "
                       "and range";
  }
  findings.push_back(finding);
}

}  // namespace paloc
