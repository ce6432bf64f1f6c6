#pragma once

namespace paloc {

/// Largest resident memory of this process so far (MB).
double peakRssMb();

}  // namespace paloc
