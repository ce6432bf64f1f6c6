#include "paloc/tools/quantile.h"

#include <algorithm>
#include <cmath>

namespace paloc {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto lower = [](double a, double b) { return std::isnan(b) ? !std::isnan(a) : a < b; };
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), below, values.end(), lower);
  const double part = place - std::floor(place);
  if (part == 0) return *below;
  const double above = *std::min_element(below + 1, values.end(), lower);
  return *below + part * (above - *below);
}

}  // namespace paloc
