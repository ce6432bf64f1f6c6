#include "lzf.h"

#include <cstring>

namespace paloc {

bool unpackLzf(std::span<const std::byte> packed, std::span<std::byte> out) {
  std::size_t in = 0;
  std::size_t done = 0;
  const auto byteAt = [&](std::size_t i) { return std::to_integer<std::size_t>(packed[i]); };
  while (in < packed.size()) {
    const std::size_t control = byteAt(in++);
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > packed.size() - in || length > out.size() - done) return false;
      std::memcpy(out.data() + done, packed.data() + in, length);
      in += length;
      done += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (in == packed.size()) return false;
      length += byteAt(in++);
    }
    length += 2;
    if (in == packed.size()) return false;
    const std::size_t distance = ((control & 31U) << 8U) + byteAt(in++) + 1;
    if (distance > done || length > out.size() - done) return false;
    // Byte by byte: the source may overlap what is being written, and then repeats it.
    for (std::size_t i = 0; i < length; ++i, ++done) out[done] = out[done - distance];
  }
  return done == out.size();
}

}  // namespace paloc
