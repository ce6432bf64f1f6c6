#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace paloc {

/// A number as printf would show it.
inline std::string figure(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// "once", "7 times".
inline std::string timesText(std::uint64_t count) {
  return count == 1 ? "once" : std::to_string(count) + " times";
}

/// "1 time", "7 times": where more figures follow.
inline std::string timesInFigures(int count) {
  return std::to_string(count) + (count == 1 ? " time" : " times");
}

}  // namespace paloc
