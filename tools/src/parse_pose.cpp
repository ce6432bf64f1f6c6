#include "paloc/tools/parse_pose.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"

namespace paloc {

mrpt::poses::CPose3D parsePose(const std::string& pose, const std::string& option) {
  std::array<double, 6> values{};
  std::string_view rest = pose;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t comma = rest.find(',');
    const std::string_view word = rest.substr(0, comma);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), values[i]);
    const bool last = i + 1 == values.size();
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(values[i]) ||
        last != (comma == std::string_view::npos)) {
      throw UsageError(text(option, ": '", pose, "' is not x,y,z,yaw,pitch,roll (m, degrees)"));
    }
    if (!last) rest.remove_prefix(comma + 1);
  }
  constexpr double kRad = std::numbers::pi / 180;
  return {values[0], values[1], values[2], values[3] * kRad, values[4] * kRad, values[5] * kRad};
}

}  // namespace paloc
