#include "paloc/tools/html_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace paloc {

std::string escapeHtml(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7F) {
      out += "\xEF\xBF\xBD";
    } else {
      out += c;
    }
  }
  return out;
}

std::string fixedNumber(double value, int decimals) {
  if (!std::isfinite(value)) return "\xE2\x80\x93";
  std::array<char, 400> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::fixed, decimals);
  std::string text(buffer.data(), end);
  // A negative number that is rounded to nothing loses its sign.
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string shortNumber(double value) {
  const double size = std::abs(value);
  if (size > 0 && (size < 1e-4 || size >= 1e7)) {
    std::array<char, 64> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                            std::chars_format::scientific, 1);
    return {buffer.data(), end};
  }
  const int digits_before = size < 1e-4 ? 1 : static_cast<int>(std::floor(std::log10(size))) + 1;
  return fixedNumber(value, std::clamp(3 - digits_before, 0, 6));
}

std::string countText(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(text.size()) - 3; i > 0; i -= 3) {
    text.insert(static_cast<std::size_t>(i), "\xE2\x80\xAF");
  }
  return text;
}

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
  return countText(count) + ' ' + std::string(count == 1 ? one : many);
}

std::string shareText(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return "\xE2\x80\x93";
  const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  if (part == 0 || part == whole) return fixedNumber(percent, 0) + " %";
  if (percent < 0.1) return "less than 0.1 %";
  return fixedNumber(std::min(percent, 99.9), 1) + " %";
}

std::string sizeText(std::uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  if (size < 1e3) return std::to_string(bytes) + " B";
  if (size < 1e6) return shortNumber(size / 1e3) + " kB";
  if (size < 1e9) return shortNumber(size / 1e6) + " MB";
  return shortNumber(size / 1e9) + " GB";
}

std::string lengthText(double metres) {
  if (!std::isfinite(metres)) return "\xE2\x80\x93";
  if (std::abs(metres) < 0.01) return fixedNumber(1000 * metres, 1) + " mm";
  if (std::abs(metres) < 1) return fixedNumber(100 * metres, 1) + " cm";
  return shortNumber(metres) + " m";
}

}  // namespace paloc
