#include "paloc/tools/synth_sensor.h"

#include <cmath>
#include <numbers>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/tools/synth_random.h"

namespace paloc::synth {
namespace {

/// `count` beams from `lowest_deg` to `highest_deg`, evenly.
std::vector<double> evenBeams(int count, double lowest_deg, double highest_deg) {
  std::vector<double> beams;
  for (int i = 0; i < count; ++i) {
    const double deg = lowest_deg + (highest_deg - lowest_deg) * i / (count - 1);
    beams.push_back(deg * std::numbers::pi / 180);
  }
  return beams;
}

SensorModel os1() {
  SensorModel s;
  s.elevation_rad = evenBeams(128, -22.5, 22.5);
  s.columns = 1024;
  s.max_range_m = 90;
  return s;
}

SensorModel vlp16() {
  SensorModel s;
  s.elevation_rad = evenBeams(16, -15, 15);
  s.columns = 1800;
  s.max_range_m = 100;
  return s;
}

SensorModel xt32() {
  SensorModel s;
  s.elevation_rad = evenBeams(32, -16, 15);
  s.columns = 2000;
  s.min_range_m = 0.3;
  s.max_range_m = 80;
  s.range_noise_m = 0.01;
  return s;
}

/// 120 x 90 degrees in steps of 0.625 degrees, as the RoboSense E1 has.
SensorModel solidState() {
  constexpr double kDegree = std::numbers::pi / 180, kStepDeg = 0.625;
  SensorModel s;
  s.elevation_rad = evenBeams(144, -45 + kStepDeg / 2, 45 - kStepDeg / 2);
  s.columns = 192;
  s.field_rad = 120 * kDegree;
  s.first_azimuth_rad = (60 - kStepDeg / 2) * kDegree;
  s.min_range_m = 0.2;
  s.max_range_m = 30;
  return s;
}

constexpr std::pair<const char*, SensorModel (*)()> kSensors[] = {
    {"os1-128", os1}, {"vlp-16", vlp16}, {"xt-32", xt32}, {"solid-state", solidState}};

/// Whether the receiver sees the echo: its strength falls with the square of the range, and grazing
/// rays get lost more and more below five degrees.
bool returns(const SensorModel& sensor, double range, double reflectivity, double cos_incidence,
             RandomStream& random) {
  if (range < sensor.min_range_m) return false;
  const double strength = reflectivity * cos_incidence * std::pow(sensor.max_range_m / range, 2);
  constexpr double kGrazing = 0.087;
  if (strength < 0.1) return false;
  return cos_incidence > kGrazing || random.uniform() < cos_incidence / kGrazing;
}

}  // namespace

std::vector<std::string> sensorNames() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : kSensors) names.emplace_back(name);
  return names;
}

SensorModel makeSensor(const std::string& name) {
  std::string known;
  for (const auto& [sensor_name, maker] : kSensors) {
    if (name == sensor_name) {
      SensorModel sensor = maker();
      sensor.name = name;
      return sensor;
    }
    known += (known.empty() ? "" : ", ") + std::string(sensor_name);
  }
  throw UsageError("--sensor: there is no sensor \"" + name + "\"; there are: " + known);
}

LidarSimulator::LidarSimulator(const SensorModel& sensor, const Pose& T_body_lidar,
                               const SceneMesh& mesh, const Surroundings& surroundings,
                               const Motion& motion, std::uint64_t seed)
    : sensor_(sensor),
      T_body_lidar_(T_body_lidar),
      mesh_(mesh),
      surroundings_(surroundings),
      motion_(motion),
      seed_(seed) {}

obs::CObservationLidarScan::Ptr LidarSimulator::scan(std::uint64_t index, TimeNs stamp_ns) const {
  auto scan = obs::CObservationLidarScan::Create();
  scan->timestamp = toMrptTime(stamp_ns);
  scan->sensorLabel = "lidar";
  scan->sensorPoseOnRobot = toMrpt(T_body_lidar_);
  scan->duration_ns = static_cast<std::uint32_t>(sensor_.duration());

  RandomStream random(seed_, RandomPurpose::kScan, index);
  const std::size_t beams = sensor_.elevation_rad.size();
  std::vector<Vec3> directions_lidar(beams);
  std::vector<Eigen::Vector3f> directions_map(beams);
  std::vector<RayHit> hits(beams);
  for (int column = 0; column < sensor_.columns; ++column) {
    const TimeNs delay = sensor_.columnDelay(column);
    const MotionState state = motion_.at(stamp_ns + delay);
    const Pose T_map_lidar = state.T_map_body * T_body_lidar_;
    const double azimuth = sensor_.columnAzimuth(column);
    for (std::size_t i = 0; i < beams; ++i) {
      const double elevation = sensor_.elevation_rad[i];
      directions_lidar[i] = Vec3(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      directions_map[i] = (T_map_lidar.rotation * directions_lidar[i]).cast<float>();
    }
    surroundings_.cast(stamp_ns + delay, T_map_lidar.position, directions_map, random, hits);
    for (std::size_t i = 0; i < beams; ++i) {
      if (!hits[i].valid()) continue;
      const double cos_incidence = std::abs(hits[i].normal_scene.dot(directions_map[i]));
      const double reflectivity = mesh_.surface_reflectivity[hits[i].surface];
      if (!returns(sensor_, hits[i].distance_m, reflectivity, cos_incidence, random)) continue;
      const double range = hits[i].distance_m + sensor_.range_noise_m * random.normal();
      const Vec3 point = range * directions_lidar[i];
      scan->x.push_back(static_cast<float>(point.x()));
      scan->y.push_back(static_cast<float>(point.y()));
      scan->z.push_back(static_cast<float>(point.z()));
      scan->dt_ns.push_back(static_cast<std::uint32_t>(delay));
      scan->intensity.push_back(
          static_cast<std::uint16_t>(std::lround(255 * reflectivity * cos_incidence)));
      scan->ring.push_back(static_cast<std::uint16_t>(i));
    }
  }
  return scan;
}

}  // namespace paloc::synth
