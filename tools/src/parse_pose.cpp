#include "paloc/tools/parse_pose.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"

namespace paloc {
namespace {

// So many finite numbers between commas, and nothing else.
template <std::size_t N>
std::optional<std::array<double, N>> parseNumbers(std::string_view rest) {
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t comma = rest.find(',');
    const std::string_view word = rest.substr(0, comma);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), values[i]);
    const bool last = i + 1 == N;
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(values[i]) ||
        last != (comma == std::string_view::npos)) {
      return std::nullopt;
    }
    if (!last) rest.remove_prefix(comma + 1);
  }
  return values;
}

}  // namespace

mrpt::poses::CPose3D parsePose(const std::string& pose, const std::string& option) {
  const auto values = parseNumbers<6>(pose);
  if (!values) {
    throw UsageError(text(option, ": '", pose, "' is not x,y,z,yaw,pitch,roll (m, degrees)"));
  }
  constexpr double kRad = std::numbers::pi / 180;
  const auto& [x, y, z, yaw, pitch, roll] = *values;
  return {x, y, z, yaw * kRad, pitch * kRad, roll * kRad};
}

Vec3 parsePosition(const std::string& position, const std::string& option) {
  const auto values = parseNumbers<3>(position);
  if (!values) throw UsageError(text(option, ": '", position, "' is not x,y,z (m)"));
  return {(*values)[0], (*values)[1], (*values)[2]};
}

}  // namespace paloc
