#include "paloc/tools/error_statistics.h"

#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

double quantile(const std::vector<double>& sorted, double q) {
  const double place = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

ErrorStatistics errorStatistics(std::vector<double> errors) {
  ErrorStatistics s;
  s.count = errors.size();
  if (errors.empty()) return s;
  const auto n = static_cast<double>(errors.size());
  std::sort(errors.begin(), errors.end());
  double sum = 0, sum_sq = 0;
  for (const double e : errors) {
    sum += e;
    sum_sq += e * e;
  }
  s.mean = sum / n;
  s.rmse = std::sqrt(sum_sq / n);
  double deviation_sq = 0;
  for (const double e : errors) deviation_sq += (e - s.mean) * (e - s.mean);
  s.std = std::sqrt(deviation_sq / n);
  s.median = quantile(errors, 0.5);
  s.p95 = quantile(errors, 0.95);
  s.min = errors.front();
  s.max = errors.back();
  return s;
}

}  // namespace paloc
