#include <cmath>
#include <cstdio>
#include <numbers>

#include "paloc/core/text.h"
#include "paloc/tools/check_recording.h"
#include "paloc/tools/finding_json.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

std::string lineOf(const Finding& finding, TimeNs first_ns) {
  std::string line =
      formatted("%-8s %-17s ", severityName(finding.severity), finding.check.c_str());
  if (finding.t_ns) line += formatted("%.3f s: ", secondsBetween(first_ns, *finding.t_ns));
  return line + finding.sentence + '\n';
}

std::string lineOf(const MotionComparison& motion) {
  std::string line = text("compared: ", motion.of_odometry ? "odometry '" : "LiDAR '", motion.label,
                          "' with IMU '", motion.imu_label, "', ", motion.steps, " steps: ");
  if (!motion.turns) return line + "hardly turns\n";
  if (!motion.fits) return line + "they do not fit\n";
  line += formatted("clock %+.2f ms (sigma %.2f), gyroscope's scale %.3f", 1e3 * motion.offset_s,
                    1e3 * motion.offset_sigma_s, motion.gyro_scale);
  if (motion.R_body_sensor.determinant() < 0) {
    line += ", axes left-handed";
  } else if (motion.rotation_error_sigma_rad > 0) {
    line += formatted(", axes off by %.2f deg (sigma %.2f)",
                      motion.rotation_error_body.norm() / kDegree,
                      motion.rotation_error_sigma_rad / kDegree);
  } else {
    line += ", axes known too badly to tell";
  }
  return line + formatted("; turning %.2f deg a step, unexplained as given %.2f, at best %.2f\n",
                          motion.turn_rms_rad / kDegree, motion.configured_rms_rad / kDegree,
                          motion.fitted_rms_rad / kDegree);
}

Json jsonOf(const MotionComparison& motion) {
  Json json = {{"sensor", motion.of_odometry ? "odometry" : "lidar"},
               {"label", motion.label},
               {"imu_label", motion.imu_label},
               {"turns", motion.turns},
               {"fits", motion.fits},
               {"steps", motion.steps},
               {"turn_rms_rad", motion.turn_rms_rad}};
  if (!motion.fits) return json;
  const Vec3& error = motion.rotation_error_body;
  json["configured_rms_rad"] = motion.configured_rms_rad;
  json["fitted_rms_rad"] = motion.fitted_rms_rad;
  json["imu_late_s"] = motion.offset_s;
  json["imu_late_sigma_s"] = motion.offset_sigma_s;
  json["offset_observable"] = motion.offset_observable;
  json["gyro_scale"] = motion.gyro_scale;
  json["gyro_scale_sigma"] = motion.gyro_scale_sigma;
  json["left_handed"] = motion.R_body_sensor.determinant() < 0;
  json["rotation_error_rad"] = {error.x(), error.y(), error.z()};
  json["rotation_error_sigma_rad"] = motion.rotation_error_sigma_rad;
  return json;
}

}  // namespace

std::string textOf(const RecordingCheck& check) {
  std::string out;
  for (const Finding& finding : check.findings) out += lineOf(finding, check.first_ns);
  for (const Finding& note : check.notes) out += lineOf(note, check.first_ns);
  for (const MotionComparison& motion : check.motions) out += lineOf(motion);
  if (!check.damage.empty()) out += "damaged: " + check.damage + '\n';
  const std::size_t count = check.findings.size();
  out +=
      text(check.file, ": ", check.observations, " observations, ",
           count == 0 ? "nothing wrong found" : text(count, count == 1 ? " finding" : " findings"),
           '\n');
  return out;
}

Json jsonOf(const RecordingCheck& check) {
  Json json = {{"file", check.file},
               {"observations", check.observations},
               {"findings", jsonOf(check.findings)},
               {"notes", jsonOf(check.notes)},
               {"motion", Json::array()},
               {"damage", check.damage}};
  for (const MotionComparison& motion : check.motions) json["motion"].push_back(jsonOf(motion));
  return json;
}

}  // namespace paloc
