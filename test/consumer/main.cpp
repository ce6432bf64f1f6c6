#include <exception>
#include <iostream>

#include "paloc/config/config.h"
#include "paloc/frontends/CObservationLidarScan.h"

int main() {
  try {
    const auto config = paloc::loadConfig(PALOC_SHARE_DIR "/sensors/vlp-16.yaml");
    const paloc::obs::CObservationLidarScan scan;
    std::cout << "range noise " << config.matcher.range_noise_m << " m, scans come as "
              << scan.GetRuntimeClass()->className << '\n';
    return 0;
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
