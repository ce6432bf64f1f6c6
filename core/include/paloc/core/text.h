#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace paloc {

namespace detail {
inline void appendTo(std::string& out, std::string_view part) { out += part; }
inline void appendTo(std::string& out, char part) { out += part; }
template <std::integral T>
void appendTo(std::string& out, T part) {
  out += std::to_string(part);
}
}  // namespace detail

/// A sentence out of its parts: strings, characters and integers.
template <typename... Parts>
std::string text(const Parts&... parts) {
  std::string out;
  (detail::appendTo(out, parts), ...);
  return out;
}

}  // namespace paloc
