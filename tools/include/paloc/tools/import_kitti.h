#pragma once

#include "paloc/tools/import_recording.h"

namespace paloc {

struct ImportKittiSettings {
  std::filesystem::path drive;  ///< .../2011_09_26/2011_09_26_drive_0001_sync
  std::filesystem::path
      calibration;                ///< folder of calib_imu_to_velo.txt; empty: drive or its parent
  bool has_T_body_lidar = false;  ///< scans.T_body_lidar is stated
  ScanConversion scans;
  ImportOutput output;
};

/// Imports a drive of KITTI's raw data (Geiger et al., "Vision meets Robotics", 2013): the
/// Velodyne's scans, and of the oxts unit, which is the body, accelerations (ax, ay, az) and rates
/// (wx, wy, wz) in the vehicle's own axes, and its pose in the Mercator projection of KITTI's
/// development kit, relative to the first. Throws UsageError, IoError.
ImportSummary importKitti(const ImportKittiSettings& settings,
                          const std::function<void(double)>& progress);

}  // namespace paloc
