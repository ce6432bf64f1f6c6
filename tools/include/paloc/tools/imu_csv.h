#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "paloc/core/imu_sample.h"

namespace paloc {

/// What was read of an IMU's file.
struct ImuCsv {
  std::vector<ImuSample> samples;  ///< in the order of the file
  std::uint64_t nonfinite = 0;     ///< rows with a value that is not finite, left out
  std::string other_columns;       ///< names of columns that are not read
};

/// Reads a CSV with the columns t_s, ax_mps2, ay_mps2, az_mps2, wx_radps, wy_radps, wz_radps, in
/// any order, found by their names in the first line. Throws IoError (file, line, column).
ImuCsv readImuCsv(const std::filesystem::path& file);

}  // namespace paloc
