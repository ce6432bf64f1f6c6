#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/core/imu_sample.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/tools/scan_observation.h"

namespace paloc {

/// What all importers share: where the rawlog goes and how it is written.
struct ImportOutput {
  std::filesystem::path file;
  RawlogWriter::Compression compression = RawlogWriter::Compression::kNone;
  bool overwrite = false;
  std::string imu_label = "imu";
  std::string odometry_label = "odometry";
};

/// The parts of a recording. Scans are loaded when their turn comes.
struct ImportParts {
  std::vector<ScanEntry> scans;
  std::vector<ImuSample> imu;
  std::vector<StampedPose> odometry;            ///< T_odom_body, or that of its sensor; cumulative
  std::map<TimeNs, Mat6> odometry_covariances;  ///< by stamp, tangent space of Pose; none: unknown
  Pose T_body_odometry;                         ///< where the sensor of the odometry is
  /// Loads a scan; if there is none, it is in the entry's file. Throws IoError.
  std::function<PointCloud(const ScanEntry&)> load;
};

/// What came of an import.
struct ImportSummary {
  std::string output;
  std::uint64_t bytes = 0;
  double duration_s = 0;
  std::uint64_t scans = 0, points = 0, imu_samples = 0, odometry_poses = 0;
  std::uint64_t scans_with_times = 0, scans_deskewed = 0;
  std::map<std::string, std::uint64_t> not_used;  ///< reason -> how many
  std::map<std::string, std::uint64_t> noticed;   ///< used, but worth a word
  std::vector<std::string> notes;                 ///< sentences
  bool complete() const { return not_used.empty(); }
};

/// Writes all observations in order of time: the streams are merged by stamp. Scans that cannot be
/// read are counted in `summary`. `progress` is told the share that is done. Throws IoError if no
/// scan can be read, or the rawlog cannot be written.
void writeRecording(ImportParts parts, const ScanConversion& how, const ImportOutput& output,
                    const std::function<void(double)>& progress, ImportSummary& summary);

/// Notes it if forces look like g, not m/s2.
void noteImuUnit(const std::vector<ImuSample>& imu, ImportSummary& summary);

std::string tableOf(const ImportSummary& summary);
nlohmann::json jsonOf(const ImportSummary& summary);

}  // namespace paloc
