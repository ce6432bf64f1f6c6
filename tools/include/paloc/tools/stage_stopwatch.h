#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "paloc/core/stage_timer.h"

namespace paloc {

/// Time spent in one stage, over a whole run (ms).
struct StageTimes {
  std::string name;
  std::vector<double> calls_ms;  ///< in the order of the calls
  double total_ms = 0;

  /// The value below which a share of the calls lies: percentile(0.5) is the median.
  double percentile(double share) const;
};

/// Measures stages by wall clock. Stages may nest; each counts its own whole time. One object
/// serves one thread.
class StageStopwatch : public StageTimer {
 public:
  void begin(const char* stage) override;
  void end(const char* stage) override;
  /// In the order in which they first began.
  const std::vector<StageTimes>& stages() const { return stages_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<Clock::time_point> started_;
  std::vector<StageTimes> stages_;
};

}  // namespace paloc
