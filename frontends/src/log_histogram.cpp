#include "log_histogram.h"

#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

constexpr double kSmallest = 1e-7;
const double kLogStep = std::log(1.01);

}  // namespace

int LogHistogram::binOf(double value) {
  if (!(value > kSmallest)) return 0;
  return static_cast<int>(std::min<double>(kBins - 1, 1 + std::log(value / kSmallest) / kLogStep));
}

double LogHistogram::valueOf(int bin) { return kSmallest * std::exp((bin - 0.5) * kLogStep); }

void LogHistogram::add(double value) {
  ++bins_[static_cast<std::size_t>(binOf(value))];
  ++count_;
}

double LogHistogram::quantile(double q) const {
  if (count_ == 0) return 0;
  const auto wanted = static_cast<std::uint64_t>(q * static_cast<double>(count_ - 1)) + 1;
  std::uint64_t below = 0;
  std::size_t bin = 0;
  while (bin + 1 < bins_.size() && below + bins_[bin] < wanted) below += bins_[bin++];
  return valueOf(static_cast<int>(bin));
}

std::uint64_t LogHistogram::countAbove(double value) const {
  std::uint64_t count = 0;
  for (auto bin = static_cast<std::size_t>(binOf(value)) + 1; bin < bins_.size(); ++bin) {
    count += bins_[bin];
  }
  return count;
}

}  // namespace paloc
