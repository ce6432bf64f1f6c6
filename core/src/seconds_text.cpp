#include "paloc/core/seconds_text.h"

#include <cstdlib>

namespace paloc {

std::string secondsText(TimeNs t_ns) {
  // The quotient and the remainder of a negative time are negative or zero both.
  const std::string decimals = std::to_string(std::abs(t_ns % kNsPerSecond));
  return (t_ns < 0 ? "-" : "") + std::to_string(std::abs(t_ns / kNsPerSecond)) + '.' +
         std::string(9 - decimals.size(), '0') + decimals;
}

}  // namespace paloc
