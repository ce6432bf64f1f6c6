#include "motion_judges.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {

std::string nameOf(const MotionComparison& motion) {
  return text(motion.of_odometry ? "the odometry '" : "the LiDAR '", motion.label, "'");
}

Finding findingOf(const MotionComparison& motion, const std::string& check, Severity severity) {
  Finding finding;
  finding.check = check;
  finding.severity = severity;
  finding.label = motion.label;
  return finding;
}

void judgeAgreement(const MotionComparison& motion, Findings& findings) {
  if (!motion.turns) {
    Finding finding = findingOf(motion, "motion", Severity::kNote);
    finding.sentence = text(
        "the body hardly turns: axes, unit and clock of the IMU cannot be "
        "compared with ",
        nameOf(motion), "; swing the platform for ten seconds to have them checked");
    findings.push_back(finding);
  } else if (motion.one_turn_open) {
    Finding finding = findingOf(motion, "motion", Severity::kNote);
    finding.sentence = text("the place does not tell ", nameOf(motion),
                            " how it turns about one axis (a round hall, a tunnel): axes, unit and "
                            "clock of the IMU cannot be compared with it there");
    findings.push_back(finding);
  } else if (!motion.fits) {
    Finding finding = findingOf(motion, "motion", Severity::kError);
    finding.value = motion.fitted_rms_rad / motion.turn_rms_rad;
    finding.sentence = text(
        "the gyroscope of the IMU '", motion.imu_label, "' and ", nameOf(motion),
        " do not see the same turning, whatever the axes, unit and clock (within 0.25 s): look "
        "whether both are of the same recording and platform, and at the point times");
    findings.push_back(finding);
  }
}

}  // namespace paloc
