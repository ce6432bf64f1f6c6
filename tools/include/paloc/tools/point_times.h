#pragma once

#include <optional>
#include <string>
#include <vector>

#include "paloc/core/time.h"

/// How the time field of a folder of clouds is to be read: its unit, and what it counts from. It is
/// decided once for the whole folder, from the values and the field's type, and told.
namespace paloc {

enum class TimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };
enum class TimeReference {
  kStamp,     ///< after the scan's stamp
  kAbsolute,  ///< on the clock of the stamps
  kEnd,       ///< negative: before the scan's last point
};

/// The time field of one scan.
struct PointTimeSample {
  TimeNs stamp_ns = 0;
  double min = 0, max = 0;  ///< of the finite values, in the field's own unit
  std::string field;
  bool integer = false;
};

struct PointTimeRule {
  TimeUnit unit = TimeUnit::kNanoseconds;
  TimeReference reference = TimeReference::kStamp;
  std::string sentence;  ///< what was decided and why
};

/// The usual time from scan to scan (s): the median step, where stamps go on; 0.1 if none does.
double scanPeriod(const std::vector<TimeNs>& stamps);

/// Decides by the length of the scans against `period_s`, the time from scan to scan (a factor of
/// a thousand lies between two units), and by where the values lie against the stamps. What is
/// given is not decided. Throws IoError if the values fit nothing.
PointTimeRule decidePointTimes(const std::vector<PointTimeSample>& samples, double period_s,
                               std::optional<TimeUnit> unit,
                               std::optional<TimeReference> reference);

/// Marks a time that is not finite or does not fit.
inline constexpr TimeNs kNoTime = INT64_MIN;

/// The values of a scan as times of its points. `last_ns`: the stamp of its last point, if stated.
std::vector<TimeNs> readPointTimes(const PointTimeRule& rule, const std::vector<double>& values,
                                   TimeNs stamp_ns, std::optional<TimeNs> last_ns);

}  // namespace paloc
