#include "calibration_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "paloc/core/mrpt_pose.h"
#include "paloc/core/so3.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSure = 5;  // sigmas

std::string threeOf(const Vec3& v, const char* format, const char* between = ", ") {
  return text(figure(format, v.x()), between, figure(format, v.y()), between,
              figure(format, v.z()));
}

// Of a vector, in sigmas: the root of the mean of squares.
double sigmasOff(const Vec3& v, const Vec3& sigma) {
  return std::sqrt(v.cwiseQuotient(sigma).squaredNorm() / 3);
}

// As options take it: a word without spaces.
std::string poseText(const Pose& T_body_lidar) {
  const mrpt::poses::CPose3D pose = toMrpt(T_body_lidar);
  return text(threeOf(T_body_lidar.position, "%.4f", ","), ",",
              figure("%.3f", pose.yaw() / kDegree), ",", figure("%.3f", pose.pitch() / kDegree),
              ",", figure("%.3f", pose.roll() / kDegree));
}

std::string extrinsic(const CalibrationBlock& block, const Pose& T_body_lidar) {
  const CalibrationVector sigma = block.covariance.diagonal().cwiseSqrt();
  const Vec3 turned = so3::log(block.value.R), moved = block.value.moved_body;
  const Vec3 sigma_turned = sigma.segment<3>(lio_calibration::kRotation);
  const Vec3 sigma_moved = sigma.segment<3>(lio_calibration::kPosition);
  std::string sentence =
      text("fast_lio turns T_body_lidar by ", threeOf(turned / kDegree, "%.3f"),
           " deg about the body's axes (sigmas ", threeOf(sigma_turned / kDegree, "%.3f"),
           ") and moves it by ", threeOf(1e3 * moved, "%.1f"), " mm along them (sigmas ",
           threeOf(1e3 * sigma_moved, "%.1f"), ")");
  if (std::max(sigmasOff(turned, sigma_turned), sigmasOff(moved, sigma_moved)) > kSure) {
    sentence += text(": import the recording with --T-body-lidar ",
                     poseText(block.value.corrected(T_body_lidar)));
  }
  return sentence;
}

std::string timeOffset(const CalibrationBlock& block) {
  const double late_s = block.imuLateS();
  const double sigma_s =
      std::sqrt(block.covariance(lio_calibration::kTimeOffset, lio_calibration::kTimeOffset));
  std::string sentence =
      text("fast_lio finds the IMU's stamps ", figure("%.3f", 1e3 * late_s),
           " ms late against the LiDAR's (sigma ", figure("%.3f", 1e3 * sigma_s), " ms)");
  if (std::abs(late_s) > kSure * sigma_s) {
    sentence += text(": ", late_s > 0 ? "subtract " : "add ", figure("%.4f", std::abs(late_s)),
                     late_s > 0 ? " s from" : " s to", " them before the import");
  }
  return sentence;
}

}  // namespace

std::vector<std::string> reportOf(const CalibrationBlock& block, const Pose& T_body_lidar,
                                  const FastLioSettings& settings) {
  std::vector<std::string> sentences;
  if (settings.estimate_extrinsic) sentences.push_back(extrinsic(block, T_body_lidar));
  if (settings.estimate_time_offset) sentences.push_back(timeOffset(block));
  return sentences;
}

}  // namespace paloc
