#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace paloc {

/// Text as it may stand between tags and in quoted attributes: markup escaped, control characters
/// replaced (they are not allowed in HTML).
std::string escapeHtml(std::string_view text);

/// A number with so many decimals, in any locale the same; a dash if it is not finite.
std::string fixedNumber(double value, int decimals);

/// A number with three significant digits and no exponent where it can be read without ("0.0123",
/// "47.0", "1250").
std::string shortNumber(double value);

/// A count with its thousands set apart by a thin space ("929 000").
std::string countText(std::uint64_t count);

/// "1 pose", "12 poses".
std::string counted(std::uint64_t count, std::string_view one, std::string_view many);

/// "47 %", "less than 0.1 %", "100 %" for all only, "99.9 %" for almost.
std::string shareText(std::uint64_t part, std::uint64_t whole);

/// Bytes in a unit that suits ("1.2 GB").
std::string sizeText(std::uint64_t bytes);

/// Metres in the unit that suits a figure of that size ("8 mm", "1.9 cm", "33 m").
std::string lengthText(double metres);

}  // namespace paloc
