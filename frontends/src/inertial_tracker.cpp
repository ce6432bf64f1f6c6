#include "inertial_tracker.h"

#include "sentence_parts.h"

namespace paloc {
namespace {

constexpr double kNoteworthyNoise = 5;  // of the IMU, in that of the settings

}  // namespace

std::vector<std::string> InertialTracker::notes(int scans) const {
  std::vector<std::string> sentences;
  if (inertia_.intervalsWithoutImu() > 0) {
    sentences.push_back("the IMU does not cover " + std::to_string(inertia_.intervalsWithoutImu()) +
                        " of " + std::to_string(scans) +
                        " scans and the way to them: taken as an even motion");
  }
  if (worst_imu_noise_ > kNoteworthyNoise) {
    sentences.push_back(
        "the IMU disagrees with the scans: its noise was taken as up to " +
        figure("%.0f", worst_imu_noise_) +
        " times that of the settings (imu.*_noise_density); look at its scale, filter and clock");
  }
  return sentences;
}

}  // namespace paloc
