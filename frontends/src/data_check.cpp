#include "data_check.h"

#include "paloc/core/text.h"

namespace paloc {

std::string CheckedStream::name() const {
  const char* what = kind == StreamKind::kLidar ? "LiDAR"
                     : kind == StreamKind::kImu ? "IMU"
                                                : "odometry";
  return text("the ", what, " '", label, "'");
}

Finding CheckedStream::finding(const std::string& check, Severity severity) const {
  Finding result;
  result.check = check;
  result.severity = severity;
  result.label = label;
  return result;
}

}  // namespace paloc
