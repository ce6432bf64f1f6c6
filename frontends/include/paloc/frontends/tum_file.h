#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/pose.h"
#include "paloc/core/time.h"

namespace paloc {

/// A pose with its time. The frames are those of the trajectory that holds it.
struct StampedPose {
  TimeNs t_ns = 0;
  Pose pose;
};

/// Reads a TUM trajectory: lines of `t x y z qx qy qz qw` (s, m, unit quaternion), `#` starts a
/// comment. Stamps are read as decimal text, exact to the nanosecond. Throws IoError (file, line,
/// field) on a missing file, a malformed line, a non-finite number, a quaternion that is not near
/// unit length, or when there is no pose at all. The order of the file is kept.
PALOC_EXPORT std::vector<StampedPose> readTum(const std::filesystem::path& file);

/// One line in TUM's form, nine decimals of a second, without the line's end.
PALOC_EXPORT std::string tumLine(const StampedPose& pose);

/// Writes a whole trajectory; throws IoError if the file cannot be written completely.
PALOC_EXPORT void writeTum(const std::filesystem::path& file,
                           const std::vector<StampedPose>& poses);

/// A decimal number of seconds ("1645002364.537699938") as nanoseconds, exactly, without a detour
/// through double. Returns false on anything but a finite decimal number (an exponent is allowed).
PALOC_EXPORT bool parseSeconds(std::string_view text, TimeNs& t_ns);

}  // namespace paloc
