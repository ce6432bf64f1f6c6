#pragma once

#include "paloc/tools/import_recording.h"

namespace paloc {

struct ImportCloudsSettings {
  std::filesystem::path folder, times_file;
  std::filesystem::path odometry_file, imu_file;  ///< empty: none
  ScanConversion scans;
  std::optional<TimeUnit> time_unit;            ///< stated, not decided
  std::optional<TimeReference> time_reference;  ///< likewise
  ImportOutput output;
};

/// Imports a folder of point clouds with a file of times. Throws UsageError, IoError.
ImportSummary importClouds(const ImportCloudsSettings& settings,
                           const std::function<void(double)>& progress);

}  // namespace paloc
