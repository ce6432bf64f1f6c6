#pragma once

#include <cstddef>
#include <vector>

namespace paloc {

/// Statistics of a list of errors, in the unit of the errors (m or rad).
struct ErrorStatistics {
  std::size_t count = 0;
  double rmse = 0;
  double mean = 0;
  double median = 0;
  double p95 = 0;  ///< 95th percentile, linearly interpolated between the sorted errors
  double std = 0;  ///< about the mean, divided by the count
  double min = 0;
  double max = 0;
};

/// All zero, with a count of zero, for an empty list.
ErrorStatistics errorStatistics(std::vector<double> errors);

}  // namespace paloc
