#include <algorithm>
#include <cmath>

#include "motion_judges.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

// Between what is harmless (1 ms) and what is not (3 ms).
constexpr double kTolerance = 0.002;  // s
constexpr double kSigmas = 4;

std::string milliseconds(double s) { return figure("%.1f", 1e3 * s) + " ms"; }

}  // namespace

void judgeClockOffset(const MotionComparison& motion, Findings& findings) {
  if (!motion.fits) return;
  if (!motion.offset_observable) {
    Finding finding = findingOf(motion, "clock-offset", Severity::kNote);
    finding.sentence =
        text("the turning changes too little to tell the clock of the IMU from that of ",
             nameOf(motion), " (sigma ", milliseconds(motion.offset_sigma_s),
             "); swing the platform for ten seconds to have it checked");
    findings.push_back(finding);
    return;
  }
  const double off = std::abs(motion.offset_s);
  if (off < std::max(kTolerance, kSigmas * motion.offset_sigma_s)) return;
  const bool late = motion.offset_s > 0;
  Finding finding = findingOf(motion, "clock-offset", Severity::kError);
  finding.value = motion.offset_s;
  finding.unit = "s";
  std::string sentence = text("the stamps of the IMU '", motion.imu_label, "' are ",
                              milliseconds(off), late ? " late" : " early", " (sigma ",
                              milliseconds(motion.offset_sigma_s), ") against ", nameOf(motion));
  if (motion.of_odometry) sentence += ", which need not be the LiDAR's clock";
  constexpr double kAlike = 0.008;  // s
  if (!late && motion.scan_duration_s > 0 && std::abs(off - motion.scan_duration_s) < kAlike) {
    sentence +=
        ", which is the length of a scan: its stamp seems to be that of its end; give it "
        "that of its first point";
  } else {
    sentence += text(": ", late ? "subtract " : "add ", figure("%.4f", off),
                     late ? " s from" : " s to", " them before the import");
  }
  finding.sentence = sentence;
  findings.push_back(finding);
}

}  // namespace paloc
