#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "paloc/core/imu_sample.h"
#include "paloc/core/state.h"

namespace paloc {

/// A row of the ground truth: Vicon or laser tracker, fused with the IMU by the data's makers.
struct EurocTruth {
  TimeNs t_ns;
  State state;
};

/// Samples of an `imu0.txt` (t[ns] wx wy wz ax ay az); none where it cannot be read.
inline std::vector<ImuSample> readEurocImu(const std::filesystem::path& file) {
  std::vector<ImuSample> samples;
  std::ifstream in(file);
  ImuSample s;
  Vec3 &w = s.omega_body, &a = s.acc_body;
  while (in >> s.t_ns >> w.x() >> w.y() >> w.z() >> a.x() >> a.y() >> a.z()) samples.push_back(s);
  return samples;
}

/// Rows of a `groundtruth.csv`; none where it cannot be read.
inline std::vector<EurocTruth> readEurocTruth(const std::filesystem::path& file) {
  std::vector<EurocTruth> rows;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    EurocTruth row;
    double v[16];
    fields >> row.t_ns;
    for (double& value : v) fields >> value;
    row.state.T_map_body.position = Vec3(v[0], v[1], v[2]);
    row.state.T_map_body.rotation =
        Eigen::Quaterniond(v[3], v[4], v[5], v[6]).normalized().toRotationMatrix();
    row.state.v_map = Vec3(v[7], v[8], v[9]);
    row.state.bias_gyro = Vec3(v[10], v[11], v[12]);
    row.state.bias_acc = Vec3(v[13], v[14], v[15]);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace paloc
