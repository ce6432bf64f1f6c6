#include "paloc/tools/synth_writers.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/core/seconds_text.h"
#include "paloc/tools/result_folder.h"

namespace paloc::synth {
namespace {

using Json = nlohmann::ordered_json;

Json poseJson(const Pose& pose) {
  const Quat q(pose.rotation);
  const Vec3& p = pose.position;
  return {{"position_m", {p.x(), p.y(), p.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

}  // namespace

void writeImuTruth(const std::filesystem::path& file, const std::vector<ImuTruth>& imu) {
  std::string csv =
      "t_s,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,bax_mps2,bay_mps2,baz_mps2,"
      "bgx_radps,bgy_radps,bgz_radps\n";
  for (const ImuTruth& row : imu) {
    const Vec3 &p = row.state.T_map_body.position, &v = row.state.v_map;
    const Vec3 &a = row.bias_acc, &g = row.bias_gyro;
    const Quat q(row.state.T_map_body.rotation);
    char line[512];
    std::snprintf(line, sizeof line,
                  "%s,%.9f,%.9f,%.9f,%.12f,%.12f,%.12f,%.12f,%.9f,%.9f,%.9f,"
                  "%.9f,%.9f,%.9f,%.10f,%.10f,%.10f\n",
                  secondsText(row.sample.t_ns).c_str(), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                  q.w(), v.x(), v.y(), v.z(), a.x(), a.y(), a.z(), g.x(), g.y(), g.z());
    csv += line;
  }
  writeTextFile(file, csv);
}

void writeDescription(const std::filesystem::path& file, const SynthSettings& settings,
                      const Scene& scene, const SensorModel& sensor, const SynthSummary& summary) {
  const ImuModel& imu = settings.imu;
  const SurveyModel& survey = settings.survey;
  Json json;
  json["scene"] = {{"name", scene.name}, {"description", scene.description}};
  json["seed"] = settings.seed;
  json["motion"] = {
      {"trajectory",
       settings.trajectory.empty() ? "walk" : settings.trajectory.filename().string()},
      {"duration_s", summary.duration_s},
      {"length_m", summary.length_m}};
  json["frames"] = {
      {"map", "the scene's frame, z up; gravity is 9.80665 m/s2 along -z"},
      {"body", "the IMU's frame: x ahead, y to the left, z up"},
      {"lidar", "the sensor's frame; a scan's points are in it, each as seen at its own time"},
      {"odom", "the odometry's own frame: the body's pose at its first stamp"},
      {"T_body_lidar", poseJson(settings.T_body_lidar)}};
  json["lidar"] = {
      {"label", "lidar"},
      {"class", "paloc::obs::CObservationLidarScan"},
      {"sensor", sensor.name},
      {"beams", sensor.elevation_rad.size()},
      {"columns", sensor.columns},
      {"field_of_view_rad", sensor.field_rad},
      {"period_s", secondsBetween(0, sensor.period_ns)},
      {"stamp", "the first column; stamp + duration_ns is the last, and the end of the scan"},
      {"duration_s", secondsBetween(0, sensor.duration())},
      {"range_noise_m", sensor.range_noise_m},
      {"min_range_m", sensor.min_range_m},
      {"max_range_m", sensor.max_range_m},
      {"scans", summary.scans},
      {"points", summary.points},
      {"scans_without_returns", summary.scans_without_returns}};
  json["imu"] = {
      {"label", "imu"},
      {"class", "mrpt::obs::CObservationIMU"},
      {"rate_hz", imu.rate_hz},
      {"samples", summary.imu_samples},
      {"accelerometer_noise_density_mps2_sqrthz",
       imu.noise.accelerometer_noise_density_mps2_sqrthz},
      {"gyroscope_noise_density_radps_sqrthz", imu.noise.gyroscope_noise_density_radps_sqrthz},
      {"accelerometer_bias_walk_mps3_sqrthz", imu.noise.accelerometer_bias_walk_mps3_sqrthz},
      {"gyroscope_bias_walk_radps2_sqrthz", imu.noise.gyroscope_bias_walk_radps2_sqrthz},
      {"initial_bias_acc_sigma_mps2", imu.initial_bias_acc_mps2},
      {"initial_bias_gyro_sigma_radps", imu.initial_bias_gyro_radps}};
  json["odometry"] = {{"label", "odometry"},
                      {"class", "mrpt::obs::CObservationRobotPose"},
                      {"stamp", "the end of each scan"},
                      {"poses", summary.odometry_poses},
                      {"drift", settings.odometry.drift},
                      {"scale", settings.odometry.scale},
                      {"step_noise_m", settings.odometry.step_noise_m},
                      {"step_noise_rad", settings.odometry.step_noise_rad},
                      {"end_error_m", summary.odometry_end_error_m}};
  if (settings.blackout_s) json["blackout_s"] = *settings.blackout_s;
  if (summary.map_points > 0) {
    json["map"] = {{"points", summary.map_points},
                   {"spacing_m", survey.spacing_m},
                   {"range_noise_m", survey.range_noise_m},
                   {"surface_bias_sigma_m", survey.surface_bias_m},
                   {"angular_step_deg", survey.angular_step_deg}};
  }
  for (const Fault& fault : settings.faults) {
    json["faults"].push_back({{"fault", toString(fault.kind)}, {"values", fault.values}});
  }
  for (const Change& change : settings.changes) {
    json["changes"].push_back({{"change", toString(change.kind)}, {"values", change.values}});
  }
  json["files"] = {
      {"recording.rawlog", "the recording (rawlog-edit -p libpaloc_frontends.so reads it)"},
      {summary.map_points > 0 ? "map.ply" : scene.name, "the prior map"},
      {"truth.tum", "T_map_body at the end of each scan"},
      {"truth_imu.csv", "pose and velocity in the map, and IMU biases, at each IMU stamp"}};
  if (!settings.changes.empty()) {
    json["files"]["changes.json"] = "how the recorded place differs from the surveyed one";
  }
  json["notes"] = summary.notes;
  writeTextFile(file, json.dump(2) + '\n');
}

}  // namespace paloc::synth
