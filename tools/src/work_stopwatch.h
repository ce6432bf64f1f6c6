#pragma once

#include <time.h>

#include "paloc/core/time.h"

namespace paloc {

/// Time passed since it was made: by the wall, and of this thread on the processor, which leaves
/// out what others did on the machine.
class WorkStopwatch {
 public:
  double wall_ms() const { return 1e-6 * static_cast<double>(now(CLOCK_MONOTONIC) - wall_begin_); }
  double cpu_ms() const {
    return 1e-6 * static_cast<double>(now(CLOCK_THREAD_CPUTIME_ID) - cpu_begin_);
  }

 private:
  static TimeNs now(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return kNsPerSecond * static_cast<TimeNs>(t.tv_sec) + static_cast<TimeNs>(t.tv_nsec);
  }

  TimeNs wall_begin_ = now(CLOCK_MONOTONIC);
  TimeNs cpu_begin_ = now(CLOCK_THREAD_CPUTIME_ID);
};

}  // namespace paloc
