#include "paloc/tools/peak_memory.h"

#include <sys/resource.h>

namespace paloc {

double peakRssMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux tells it in kB
}

}  // namespace paloc
