#include "paloc/tools/trajectory_csv.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "paloc/core/direction_name.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/seconds_text.h"

namespace paloc {
namespace {

constexpr const char* kTangentNames[] = {"x", "y", "z", "rx", "ry", "rz"};

// Of six directions: class, name and standard deviation of each.
constexpr const char* kDirectionHeader =
    "direction_t1,direction_t2,direction_t3,direction_r1,direction_r2,direction_r3,"
    "name_t1,name_t2,name_t3,name_r1,name_r2,name_r3,"
    "sigma_t1_m,sigma_t2_m,sigma_t3_m,sigma_r1_rad,sigma_r2_rad,sigma_r3_rad";

// A row of comma-separated values, built up from the left.
class CsvRow {
 public:
  CsvRow& text(const std::string& value) {
    if (!line_.empty()) line_ += ',';
    line_ += value;
    return *this;
  }
  // What was not computed stays empty.
  CsvRow& known(double value) { return std::isnan(value) ? text("") : number(value); }
  CsvRow& number(double value, const char* format = "%.9g") {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, format, value);
    return text(buffer);
  }
  CsvRow& position(const Vec3& v) {
    for (int k = 0; k < 3; ++k) number(v[k], "%.6f");
    return *this;
  }
  CsvRow& vector(const Vec3& v) {
    for (int k = 0; k < 3; ++k) number(v[k]);
    return *this;
  }
  std::string take() { return std::move(line_) + '\n'; }

 private:
  std::string line_;
};

std::string trajectoryHeader() {
  std::string header =
      "t_s,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,bax_mps2,bay_mps2,baz_mps2,bgx_radps,"
      "bgy_radps,bgz_radps";
  for (const std::string& name : covarianceColumns()) header += ',' + name;
  header +=
      ",sigma_vx_mps,sigma_vy_mps,sigma_vz_mps,sigma_bax_mps2,sigma_bay_mps2,sigma_baz_mps2,"
      "sigma_bgx_radps,sigma_bgy_radps,sigma_bgz_radps,flag,";
  return header + kDirectionHeader + '\n';
}

using Directions = std::array<MatchDirection, 6>;

// Classes, names and standard deviations; a direction without an axis has neither name nor sigma.
template <typename SigmaOf>
void addDirections(const Directions& directions, const SigmaOf& sigmaOf, CsvRow& row) {
  for (const MatchDirection& d : directions) row.text(toString(d.cls));
  for (std::size_t k = 0; k < 6; ++k) row.text(directionName(directions[k].axis_body, k >= 3));
  for (std::size_t k = 0; k < 6; ++k) {
    row.known(directions[k].axis_body.isZero() ? std::nan("") : sigmaOf(k));
  }
}

// Of the pose, along one of its directions: whoever it was that told it.
double poseSigma(const TrajectoryPoint& point, const Mat3& R_map_body, std::size_t direction) {
  const Vec3& axis_body = point.directions[direction].axis_body;
  const bool rotation = direction >= 3;
  const Vec3 axis = rotation ? axis_body : Vec3(R_map_body * axis_body);
  const Eigen::Index at = rotation ? 3 : 0;
  const Mat3 covariance = point.covariance.block<3, 3>(at, at);
  return std::sqrt(std::max(0.0, axis.dot(covariance * axis)));
}

}  // namespace

std::vector<std::string> covarianceColumns() {
  std::vector<std::string> names;
  for (int row = 0; row < 6; ++row) {
    for (int col = row; col < 6; ++col) {
      names.push_back(std::string("cov_") + kTangentNames[row] + '_' + kTangentNames[col]);
    }
  }
  return names;
}

std::string toString(DirectionClass cls) {
  switch (cls) {
    case DirectionClass::kFull:
      return "full";
    case DirectionClass::kPartial:
      return "partial";
    case DirectionClass::kNone:
      return "none";
  }
  return "unknown";
}

std::vector<StampedPose> stampedPoses(const std::vector<TrajectoryPoint>& trajectory) {
  std::vector<StampedPose> poses;
  poses.reserve(trajectory.size());
  for (const TrajectoryPoint& p : trajectory) poses.push_back({p.t_ns, fromMrpt(p.T_map_body)});
  return poses;
}

std::string trajectoryCsv(const std::vector<TrajectoryPoint>& trajectory) {
  std::string csv = trajectoryHeader();
  for (const TrajectoryPoint& p : trajectory) {
    const Pose pose = fromMrpt(p.T_map_body);
    const Eigen::Quaterniond q(pose.rotation);
    const double sign = q.w() < 0 ? -1 : 1;
    CsvRow row;
    row.text(secondsText(p.t_ns)).position(pose.position);
    for (const double c : {q.x(), q.y(), q.z(), q.w()}) row.number(sign * c, "%.9f");
    row.vector(p.v_map).vector(p.bias_acc).vector(p.bias_gyro);
    for (int r = 0; r < 6; ++r) {
      for (int c = r; c < 6; ++c) row.number(p.covariance(r, c));
    }
    row.vector(p.v_sigma).vector(p.bias_acc_sigma).vector(p.bias_gyro_sigma);
    row.text(toString(p.flag));
    addDirections(
        p.directions, [&](std::size_t k) { return poseSigma(p, pose.rotation, k); }, row);
    csv += row.take();
  }
  return csv;
}

std::string diagnosticsCsv(const std::vector<FrameDiagnostics>& diagnostics) {
  std::string csv =
      "scan_start_s,t_s,map_factor,points,matched,inliers,overlap,residual_rms_m,residual_median_m,"
      "iterations,step_x_m,step_y_m,step_z_m,step_rotation_rad,odometry_factor,imu_factor,at_rest,"
      "repairs,";
  csv += std::string(kDirectionHeader) + ",spectrum_de\n";
  for (const FrameDiagnostics& d : diagnostics) {
    const MapMatch& m = d.match;
    CsvRow row;
    row.text(secondsText(d.scan_start_ns)).text(secondsText(d.t_ns)).text(toString(m.refusal));
    for (const int count : {m.points, m.matched, m.inliers}) row.text(std::to_string(count));
    row.number(m.overlap, "%.4f").number(m.residual_rms_m, "%.6f");
    row.number(m.residual_median_m, "%.6f").text(std::to_string(m.iterations));
    row.position(d.guess_step_position).number(d.guess_step_rotation, "%.6f");
    for (const bool used : {d.has_odometry_factor, d.has_imu_factor, d.at_rest}) {
      row.text(used ? "1" : "0");
    }
    row.text(std::to_string(d.repairs));
    addDirections(
        m.directions, [&](std::size_t k) { return m.directions[k].sigma; }, row);
    row.known(m.spectrum);
    csv += row.take();
  }
  return csv;
}

}  // namespace paloc
