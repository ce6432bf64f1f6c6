#pragma once

#include <vector>

namespace paloc {

/// The value below which a share (0..1) of the values lies, linearly interpolated between the two
/// nearest; 0.5 gives the median. What is not a number counts as the highest. 0 if there is none.
double quantile(std::vector<double> values, double share);

}  // namespace paloc
