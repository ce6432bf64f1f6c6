#pragma once

#include <cmath>
#include <cstdint>

namespace paloc {

/// Time in nanoseconds since the UNIX epoch. Inside, time is always an integer; seconds appear only
/// as differences.
using TimeNs = std::int64_t;

inline constexpr TimeNs kNsPerSecond = 1'000'000'000;

/// The difference `later - earlier` in seconds.
inline double secondsBetween(TimeNs earlier, TimeNs later) {
  return static_cast<double>(later - earlier) * 1e-9;
}

/// A duration in seconds as nanoseconds, rounded to the nearest.
inline TimeNs nsFromSeconds(double seconds) { return std::llround(seconds * 1e9); }

}  // namespace paloc
