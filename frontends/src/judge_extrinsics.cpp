#include <cmath>
#include <numbers>

#include "motion_judges.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/so3.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double angleBetween(const Mat3& a, const Mat3& b) { return so3::log(a.transpose() * b).norm(); }

// Which of the body's axes, as the IMU has them, is the other sensor's idea of each: "x y -z".
std::string axesText(const Mat3& m) {
  std::string names;
  for (int row = 0; row < 3; ++row) {
    Eigen::Index axis = 0;
    m.row(row).cwiseAbs().maxCoeff(&axis);
    names += text(names.empty() ? "" : ", ", m(row, axis) < 0 ? "-" : "", "xyz"[axis]);
  }
  return names;
}

void tellLeftHanded(const MotionComparison& motion, Findings& findings) {
  // Readings to true rates, in the body's axes.
  const Mat3 m = motion.R_body_sensor_configured * motion.R_body_sensor.transpose();
  Finding finding = findingOf(motion, "extrinsics", Severity::kError);
  finding.label = motion.imu_label;
  finding.value = -1;
  finding.sentence = text("the axes of the IMU '", motion.imu_label, "' are left-handed: what ",
                          nameOf(motion), " sees as x, y, z the IMU has as ", axesText(m),
                          "; give the IMU's columns that order and those signs");
  findings.push_back(finding);
}

std::string anglesText(const Mat3& R) {
  const mrpt::poses::CPose3D pose = toMrpt(Pose{Vec3::Zero(), R});
  return text(figure("%.1f", pose.yaw() / kDegree), ", ", figure("%.1f", pose.pitch() / kDegree),
              ", ", figure("%.1f", pose.roll() / kDegree));
}

}  // namespace

void judgeExtrinsics(const MotionComparison& motion, Findings& findings) {
  constexpr double kTolerance = 1.0 * kDegree, kSigmas = 6;
  if (!motion.fits) return;
  if (motion.R_body_sensor.determinant() < 0) return tellLeftHanded(motion, findings);
  const double off = motion.rotation_error_body.norm();
  if (off < kTolerance || off < kSigmas * motion.rotation_error_sigma_rad) return;
  const Mat3& configured = motion.R_body_sensor_configured;
  const Mat3 better = so3::exp(motion.rotation_error_body) * configured;
  Finding finding = findingOf(motion, "extrinsics", Severity::kError);
  finding.value = off;
  finding.unit = "rad";
  std::string sentence =
      motion.of_odometry
          ? text("the axes of ", nameOf(motion), " are not the IMU's: turned by ",
                 figure("%.1f", off / kDegree), " deg")
          : text("the rotation of T_body_lidar is off by ", figure("%.1f", off / kDegree), " deg");
  if (motion.configured_rms_rad > motion.turn_rms_rad) {
    sentence += " (with it the gyroscope predicts the turning worse than none at all would)";
  }
  const std::string angles = text("yaw, pitch, roll of ", anglesText(better), " deg fit, where ",
                                  anglesText(configured), " are given");
  if (!motion.of_odometry && off > 4 * angleBetween(better, configured.transpose())) {
    sentence += ": it is its inverse, T_lidar_body, that was given; invert it (" + angles + ")";
  } else {
    sentence +=
        text(": ", angles, "; correct ", motion.of_odometry ? "its sensor pose" : "T_body_lidar");
  }
  finding.sentence = sentence;
  findings.push_back(finding);
}

}  // namespace paloc
