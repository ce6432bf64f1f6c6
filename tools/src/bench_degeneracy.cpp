#include "paloc/tools/bench_degeneracy.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "paloc/core/mrpt_pose.h"
#include "paloc/core/text.h"
#include "paloc/map/scan_matcher.h"
#include "paloc/map/scan_thinning.h"
#include "paloc/tools/bench_place.h"
#include "paloc/tools/synth_random.h"

namespace paloc {
namespace {

using synth::RandomPurpose;
using synth::RandomStream;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGuessSigmaM = 0.05 / std::numbers::sqrt3, kGuessSigmaRad = 0.5 * kDegree;

Vec3 normals(RandomStream& random, double sigma) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return sigma * Vec3(x, y, z);
}

synth::SurveyModel surveyModel(const BenchDegeneracySettings& settings) {
  synth::SurveyModel model;
  model.spacing_m = settings.map_spacing_m;
  model.angular_step_deg = settings.survey_step_deg;
  return model;
}

/// One scene with its map, in which sensors are tried.
class Place {
 public:
  Place(const std::string& name, const BenchDegeneracySettings& settings)
      : settings_(settings),
        place_(synth::makeScene(name), surveyModel(settings), settings.map, settings.seed) {}

  BenchDegeneracyRow tryOut(const std::string& sensor_name, std::ostream* list) const;

 private:
  LabelledDirections labelsAt(const synth::SensorModel& sensor, const Pose& T_map_body,
                              std::size_t index) const;

  const BenchDegeneracySettings& settings_;
  BenchPlace place_;
};

// The same rays without noise, thinned as the matcher does. It also averages the returns about
// each, and so knows a direction somewhat better than these labels say.
LabelledDirections Place::labelsAt(const synth::SensorModel& sensor, const Pose& T_map_body,
                                   std::size_t index) const {
  synth::SensorModel exact = sensor;
  exact.range_noise_m = 0;
  const Scan scan = place_.scanAt(exact, T_map_body, index);
  const std::vector<std::uint32_t> kept =
      ScanThinning().select(scan.points_body, scan.sensor_position_body,
                            static_cast<std::size_t>(settings_.matcher.max_points));
  std::vector<ExactPoint> points;
  std::vector<Eigen::Vector3f> rays_map;
  for (const std::uint32_t i : kept) {
    const Point3f& p = scan.points_body[i];
    points.push_back({Vec3(p.x, p.y, p.z), Vec3::Zero()});
    const Vec3 ray = points.back().position_body - scan.sensor_position_body;
    rays_map.push_back((T_map_body.rotation * ray).normalized().cast<float>());
  }
  std::vector<synth::RayHit> hits(rays_map.size());
  place_.raycaster().cast(T_map_body * scan.sensor_position_body, rays_map, hits);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].normal_body = T_map_body.rotation.transpose() * hits[i].normal_scene.cast<double>();
  }
  return labelDirections(points, sensor.range_noise_m);
}

void listDirections(std::ostream& list, const BenchDegeneracyRow& row, std::size_t pose,
                    const Pose& T_map_body, const LabelledDirections& labels,
                    const MapMatch& match) {
  // Of the position in the map's frame, of the rotation on the right.
  const Vec6 error = boxminus(fromMrpt(match.T_map_body), T_map_body);
  const Vec3 errors[2] = {error.head<3>(), T_map_body.rotation * error.tail<3>()};
  for (std::size_t i = 0; i < 6; ++i) {
    const MatchDirection& d = match.directions[i];
    const Vec3 axis = T_map_body.rotation * d.axis_body;
    const Vec3 label_axis = T_map_body.rotation * labels.axis_body[i];
    list << row.scene << ',' << row.sensor << ',' << pose << ',' << i << ','
         << toString(match.refusal) << ',' << static_cast<int>(labels.label[i]) << ','
         << labels.sigma[i] << ',' << label_axis.x() << ',' << label_axis.y() << ','
         << label_axis.z() << ',' << static_cast<int>(d.cls) << ',' << d.sigma << ','
         << errors[i / 3].dot(axis) << ',' << d.share << ',' << d.probability << ',' << axis.x()
         << ',' << axis.y() << ',' << axis.z() << ',' << T_map_body.position.x() << ','
         << T_map_body.position.y() << ',' << T_map_body.position.z() << '\n';
  }
}

BenchDegeneracyRow Place::tryOut(const std::string& sensor_name, std::ostream* list) const {
  const synth::SensorModel sensor = synth::makeSensor(sensor_name);
  MatcherSettings matching = settings_.matcher;
  matching.range_noise_m = sensor.range_noise_m;
  const auto matcher = ScanMatcher::onto(place_.map(), matching);
  BenchDegeneracyRow row{place_.scene().name, sensor_name, {}, {}};
  for (std::size_t i = 0; i < settings_.poses; ++i) {
    RandomStream random(settings_.seed, RandomPurpose::kStart, i);
    const Pose truth = place_.pose(i);
    Vec6 off;
    off << normals(random, kGuessSigmaM), normals(random, kGuessSigmaRad);
    const MapMatch match =
        matcher->match(place_.scanAt(sensor, truth, i), toMrpt(boxplus(truth, off)), 0.05, 0.01);
    const LabelledDirections labels = labelsAt(sensor, truth, i);
    if (list) listDirections(*list, row, i, truth, labels, match);
    if (!match.accepted()) {
      ++row.score.refused;
      continue;
    }
    row.directions_ms.push_back(1e3 * matcher->lastTiming().information_s);
    row.score.add(labels, match.directions);
  }
  return row;
}

}  // namespace

std::vector<BenchDegeneracyRow> benchDegeneracy(const BenchDegeneracySettings& settings,
                                                const BenchDegeneracyProgress& progress) {
  const auto scenes = settings.scenes.empty() ? synth::sceneNames() : settings.scenes;
  const auto sensors = settings.sensors.empty() ? synth::sensorNames() : settings.sensors;
  for (const std::string& sensor : sensors) synth::makeSensor(sensor);  // before the work begins
  for (const std::string& scene : scenes) synth::makeScene(scene);
  std::ofstream list;
  if (!settings.list_file.empty()) {
    list.open(settings.list_file);
    list << "scene,sensor,pose,direction,match,label,label_sigma,label_axis_x,label_axis_y,"
            "label_axis_z,class,sigma,error,share,probability,axis_x,axis_y,axis_z,x_m,y_m,z_m\n";
  }
  std::vector<BenchDegeneracyRow> rows;
  for (const std::string& scene : scenes) {
    const Place place(scene, settings);
    for (const std::string& sensor : sensors) {
      progress(text(scene, ", ", sensor));
      rows.push_back(place.tryOut(sensor, list.is_open() ? &list : nullptr));
    }
  }
  return rows;
}

}  // namespace paloc
