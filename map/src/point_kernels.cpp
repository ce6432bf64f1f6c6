#include "paloc/map/point_kernels.h"

#include <array>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

// Vectors of eight are no part of any interface.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace paloc {
namespace plain {
namespace {
#include "point_kernels.inl"
}  // namespace
}  // namespace plain

#if defined(__x86_64__)
namespace {

/// For each set of lanes, as bits: their numbers one after the other, a byte each.
struct PackedLanes {
  long long of[256]{};

  constexpr PackedLanes() {
    for (unsigned bits = 0; bits < 256; ++bits) {
      unsigned at = 0;
      for (unsigned lane = 0; lane < 8; ++lane) {
        if ((bits >> lane & 1U) == 0) continue;
        of[bits] |= static_cast<long long>(lane) << (8 * at++);
      }
    }
  }
};
constexpr PackedLanes kPackedLanes;

}  // namespace

// The compiler's own macros do not follow the pragma.
#define PALOC_KERNELS_AVX2
#pragma GCC push_options
#pragma GCC target("avx2")
namespace avx2 {
namespace {
#include "point_kernels.inl"
}  // namespace
}  // namespace avx2
#pragma GCC pop_options
#undef PALOC_KERNELS_AVX2
#endif

std::span<const PointKernels* const> allPointKernels() {
#if defined(__x86_64__)
  static constexpr std::array kAll{&plain::kKernels, &avx2::kKernels};
  return std::span(kAll).first(__builtin_cpu_supports("avx2") ? 2 : 1);
#else
  static constexpr std::array kAll{&plain::kKernels};
  return kAll;
#endif
}

const PointKernels& pointKernels() {
  static const PointKernels& quickest = *allPointKernels().back();
  return quickest;
}

}  // namespace paloc
