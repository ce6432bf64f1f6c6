#pragma once

#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

/// Four numbers side by side, by the compiler's vector types. The same bytes on every machine:
/// nothing is contracted or summed in another order.
namespace paloc {

using Float4 = float __attribute__((vector_size(16)));
using Mask4 = std::int32_t __attribute__((vector_size(16)));  ///< all bits set, or none, a lane

inline Float4 load4(const float* from) {
  Float4 lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

inline void store4(float* to, const Float4& lanes) { std::memcpy(to, &lanes, sizeof lanes); }

inline Float4 all4(float value) { return Float4{value, value, value, value}; }

inline Float4 max4(const Float4& a, const Float4& b) {
#if defined(__SSE2__)
  return _mm_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

/// One bit a lane.
inline unsigned bitsOf(const Mask4& mask) {
#if defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<const Float4&>(mask)));
#else
  return (mask[0] & 1U) | (mask[1] & 2U) | (mask[2] & 4U) | (mask[3] & 8U);
#endif
}

/// The value where the mask is set, else zero.
inline Float4 where(const Mask4& mask, const Float4& value) {
#if defined(__SSE2__)
  return _mm_and_ps(reinterpret_cast<const Float4&>(mask), value);
#else
  return mask ? value : Float4{};
#endif
}

inline float sumOf(const Float4& lanes) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }

}  // namespace paloc
