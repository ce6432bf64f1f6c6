#include "paloc/tools/stage_stopwatch.h"

#include <algorithm>

#include "paloc/tools/quantile.h"

namespace paloc {

double StageTimes::percentile(double share) const { return quantile(calls_ms, share); }

void StageStopwatch::begin(const char* stage) {
  const auto known = std::find_if(stages_.begin(), stages_.end(),
                                  [&](const StageTimes& s) { return s.name == stage; });
  if (known == stages_.end()) stages_.push_back({stage, {}, 0});
  started_.push_back(Clock::now());
}

void StageStopwatch::end(const char* stage) {
  const double ms =
      std::chrono::duration<double, std::milli>(Clock::now() - started_.back()).count();
  started_.pop_back();
  for (StageTimes& s : stages_) {
    if (s.name != stage) continue;
    s.calls_ms.push_back(ms);
    s.total_ms += ms;
  }
}

}  // namespace paloc
