#pragma once

#include <mrpt/core/Clock.h>

#include "paloc/core/time.h"

namespace paloc {

// MRPT's clock ticks every 100 ns since 1601-01-01. Integer conversions only: a round trip through
// double moves a stamp by up to 446 ns.
inline constexpr std::int64_t kUnixEpochTicks = 116'444'736'000'000'000;

inline mrpt::Clock::time_point toMrptTime(TimeNs t_ns) {
  const TimeNs ticks = t_ns >= 0 ? (t_ns + 50) / 100 : (t_ns - 50) / 100;  // to the nearest tick
  return mrpt::Clock::time_point(mrpt::Clock::duration(ticks + kUnixEpochTicks));
}

inline TimeNs fromMrptTime(mrpt::Clock::time_point t) {
  return (t.time_since_epoch().count() - kUnixEpochTicks) * 100;
}

}  // namespace paloc
