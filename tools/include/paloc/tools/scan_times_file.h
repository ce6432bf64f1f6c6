#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "paloc/core/time.h"

namespace paloc {

/// A scan of a recording that is being imported.
struct ScanEntry {
  std::filesystem::path file;
  TimeNs stamp_ns = 0;               ///< of the first point
  std::optional<TimeNs> last_ns;     ///< of the last point, if stated
  std::optional<TimeNs> forward_ns;  ///< KITTI: when the sensor looked forward
  std::size_t place = 0;             ///< ROS bag: where its message is
};

/// Reads a file of scan times: lines of `name stamp_first_s [stamp_last_s]`, names relative to
/// `folder`, `#` starts a comment. The order of the file is kept. Throws IoError (file, line).
std::vector<ScanEntry> readScanTimes(const std::filesystem::path& file,
                                     const std::filesystem::path& folder);

}  // namespace paloc
