#include "paloc/map/hilbert_curve.h"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <utility>

#include "voxel_key.h"

namespace paloc {
namespace {

/// How the bits of the axes below one level become those that the curve sees: axis i is the axis
/// `from[i]`, inverted or not. `flipped`: whether the places below run backwards.
struct Frame {
  std::array<std::uint8_t, 3> from{0, 1, 2};
  std::array<bool, 3> inverted{};
  bool flipped = false;

  auto operator<=>(const Frame&) const = default;
};

// The place of a half (bits x, y, z from the highest) in a cube; the frame becomes that within it.
std::uint8_t enter(unsigned half, Frame& frame) {
  std::array<bool, 3> seen{};
  for (std::size_t i = 0; i < 3; ++i) {
    seen[i] = ((half >> (2 - frame.from[i])) & 1U) != frame.inverted[i];
  }
  const bool flipped = frame.flipped;
  for (std::size_t i = 0; i < 3; ++i) {
    if (seen[i]) {
      frame.inverted[0] = !frame.inverted[0];
    } else {
      std::swap(frame.from[0], frame.from[i]);
      std::swap(frame.inverted[0], frame.inverted[i]);
    }
  }
  // Out of the Gray code.
  const bool first = seen[0], second = first != seen[1], third = second != seen[2];
  frame.flipped = flipped != third;
  return static_cast<std::uint8_t>((first != flipped ? 4 : 0) | (second != flipped ? 2 : 0) |
                                   (third != flipped ? 1 : 0));
}

}  // namespace

HilbertCurve::HilbertCurve() {
  std::vector<Frame> frames(1);  // by state, found as they are come to
  for (std::size_t state = 0; state < frames.size(); ++state) {
    std::array<Entry, 8>& entries = one_.emplace_back();
    for (unsigned half = 0; half < 8; ++half) {
      Frame frame = frames[state];
      const std::uint8_t place = enter(half, frame);
      const auto known = std::find(frames.begin(), frames.end(), frame);
      entries[half] = {place, static_cast<std::uint8_t>(known - frames.begin())};
      if (known == frames.end()) frames.push_back(frame);
    }
  }
  two_.resize(one_.size());
  for (std::size_t state = 0; state < one_.size(); ++state) {
    for (unsigned halves = 0; halves < 64; ++halves) {
      const Entry outer = one_[state][halves >> 3], inner = one_[outer.state][halves & 7];
      two_[state][halves] = {static_cast<std::uint8_t>(outer.place << 3 | inner.place),
                             inner.state};
    }
  }
}

std::uint64_t HilbertCurve::place(std::uint32_t x, std::uint32_t y, std::uint32_t z,
                                  int bits) const {
  const std::uint64_t halves = spreadBits(x) << 2 | spreadBits(y) << 1 | spreadBits(z);
  std::uint64_t place = 0;
  std::size_t state = 0;
  int left = bits;
  if (left % 2 != 0) {
    --left;
    const Entry entry = one_[0][(halves >> (3 * left)) & 7];
    place = entry.place, state = entry.state;
  }
  while (left > 0) {
    left -= 2;
    const Entry entry = two_[state][(halves >> (3 * left)) & 63];
    place = place << 6 | entry.place;
    state = entry.state;
  }
  return place;
}

}  // namespace paloc
