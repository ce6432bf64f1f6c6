#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "paloc/config/config.h"
#include "paloc/core/dense_trajectory.h"
#include "paloc/tools/result_folder.h"

namespace paloc {

/// Instants read from a text file: the first field of each line is a stamp in seconds (a TUM file
/// will do, or one stamp a line), `#` starts a comment. Throws IoError (file, line) on a missing
/// file, a field that is no number, or a file without a stamp. The order of the file is kept.
std::vector<TimeNs> readStamps(const std::filesystem::path& file);

/// Poses at instants of one's own, beside the trajectory at the scans' ends.
struct DensePoses {
  std::vector<TrajectoryPoint> points;
  std::uint64_t not_answered = 0;  ///< instants before the start, after the end, or in a gap
};

/// The trajectory at the instants asked for.
DensePoses posesAt(const DenseTrajectory& trajectory, const std::vector<TimeNs>& stamps);

/// Writes NAME.tum and NAME_cov.csv; returns a line that tells how many poses there are. Throws
/// IoError.
std::string writeDensePoses(const ResultFolder& folder, const std::string& name,
                            const DensePoses& poses);

}  // namespace paloc
