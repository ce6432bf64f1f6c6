#pragma once

namespace paloc {

/// Largest resident memory of this process so far (MB).
double peakRssMb();

/// Resident memory of this process now (MB); 0 where the system does not tell.
double residentMb();

}  // namespace paloc
