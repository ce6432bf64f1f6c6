#include "paloc/tools/error_statistics.h"

#include <algorithm>
#include <cmath>

#include "paloc/tools/quantile.h"

namespace paloc {

ErrorStatistics errorStatistics(std::vector<double> errors) {
  ErrorStatistics s;
  s.count = errors.size();
  if (errors.empty()) return s;
  const auto n = static_cast<double>(errors.size());
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
  s.min = *std::min_element(errors.begin(), errors.end());
  s.max = *std::max_element(errors.begin(), errors.end());
  return s;
}

}  // namespace paloc
