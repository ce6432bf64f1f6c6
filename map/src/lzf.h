#pragma once

#include <cstddef>
#include <span>

namespace paloc {

/// Unpacks LZF data. False if it is damaged or does not give exactly `out.size()` bytes.
///
/// The format: a control byte c < 32 is followed by c + 1 literal bytes; any other copies
/// (c >> 5) + 2 bytes (if c >> 5 is 7: plus the next byte) from what has been unpacked, at a
/// distance of ((c & 31) << 8) + the next byte + 1.
bool unpackLzf(std::span<const std::byte> packed, std::span<std::byte> out);

/// The most bytes that one packed byte can stand for: three of them make a copy of 264.
inline constexpr std::size_t kLzfMaxRatio = 88;

}  // namespace paloc
