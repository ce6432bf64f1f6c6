#include <charconv>
#include <limits>
#include <string>
#include <string_view>

#include "paloc/frontends/tum_file.h"

namespace paloc {
namespace {

// The digits of a decimal number and the power of ten that they are to be multiplied with.
struct Decimal {
  bool negative = false;
  std::string digits;
  int exponent = 0;
};

bool isDigit(char c) { return c >= '0' && c <= '9'; }

bool splitDecimal(std::string_view text, Decimal& out) {
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) out.negative = text[i++] == '-';
  int fraction_digits = 0;
  bool in_fraction = false;
  for (; i < text.size() && (isDigit(text[i]) || text[i] == '.'); ++i) {
    if (text[i] == '.') {
      if (in_fraction) return false;
      in_fraction = true;
    } else {
      out.digits.push_back(text[i]);
      fraction_digits += in_fraction ? 1 : 0;
    }
  }
  if (out.digits.empty()) return false;
  int exponent = 0;
  if (i < text.size()) {
    if (text[i] != 'e' && text[i] != 'E') return false;
    ++i;
    if (i + 1 < text.size() && text[i] == '+' && isDigit(text[i + 1])) ++i;
    const auto [end, error] = std::from_chars(text.data() + i, text.data() + text.size(), exponent);
    if (error != std::errc{} || end != text.data() + text.size()) return false;
    if (exponent > 10'000 || exponent < -10'000) return false;
  }
  out.exponent = exponent - fraction_digits;
  return true;
}

// digits * 10^shift as an integer, rounded half away from zero; false if it does not fit.
bool scaledInteger(const std::string& digits, long shift, std::int64_t& value) {
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  const long kept = static_cast<long>(digits.size()) + shift;
  value = 0;
  for (long i = 0; i < kept; ++i) {
    const bool beyond = i >= static_cast<long>(digits.size());
    const int digit = beyond ? 0 : digits[static_cast<std::size_t>(i)] - '0';
    if (beyond && value == 0) return true;  // zero, whatever its exponent
    if (value > (kMax - digit) / 10) return false;
    value = value * 10 + digit;
  }
  const bool round_up = kept >= 0 && kept < static_cast<long>(digits.size()) &&
                        digits[static_cast<std::size_t>(kept)] >= '5';
  if (round_up && value == kMax) return false;
  value += round_up ? 1 : 0;
  return true;
}

}  // namespace

bool parseSeconds(std::string_view text, TimeNs& t_ns) {
  Decimal decimal;
  if (!splitDecimal(text, decimal)) return false;
  std::int64_t magnitude = 0;
  if (!scaledInteger(decimal.digits, 9L + decimal.exponent, magnitude)) return false;
  t_ns = decimal.negative ? -magnitude : magnitude;
  return true;
}

}  // namespace paloc
