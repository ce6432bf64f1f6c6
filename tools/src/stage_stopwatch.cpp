#include "paloc/tools/stage_stopwatch.h"

#include <algorithm>
#include <cmath>

namespace paloc {

double StageTimes::percentile(double share) const {
  if (calls_ms.empty()) return 0;
  std::vector<double> sorted = calls_ms;
  const auto last = static_cast<double>(sorted.size() - 1);
  const auto k = static_cast<std::ptrdiff_t>(std::llround(share * last));
  std::nth_element(sorted.begin(), sorted.begin() + k, sorted.end());
  return sorted[static_cast<std::size_t>(k)];
}

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
