#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "parallel_chunks.h"
#include "raw_array.h"

namespace paloc {

/// An item by its key.
struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

/// Sorts by key, items of one key in their order (least significant digit first). Only the digits
/// that `largest_key` has are looked at. Several times as fast as a sort by comparison; the result
/// does not depend on the number of threads.
inline void radixSort(RawArray<KeyedIndex>& items, std::uint64_t largest_key,
                      tbb::task_arena& arena) {
  constexpr int kDigitBits = 11;
  constexpr std::size_t kDigits = 1U << kDigitBits;
  constexpr std::size_t kChunk = 1U << 18;
  using Counts = std::array<std::uint32_t, kDigits>;
  RawArray<KeyedIndex> sorted(items.size());
  std::vector<Counts> starts(chunkCount(items.size(), kChunk));
  const auto bits = static_cast<int>(std::bit_width(largest_key));
  for (int shift = 0; shift < bits; shift += kDigitBits) {
    const auto digit = [shift](const KeyedIndex& item) {
      return static_cast<std::size_t>(item.key >> shift) & (kDigits - 1);
    };
    forEachChunk(arena, items.size(), kChunk,
                 [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                   starts[chunk].fill(0);
                   for (std::size_t i = begin; i < end; ++i) ++starts[chunk][digit(items[i])];
                 });
    std::uint32_t start = 0;
    for (std::size_t d = 0; d < kDigits; ++d) {
      for (Counts& counts : starts) start += std::exchange(counts[d], start);
    }
    forEachChunk(arena, items.size(), kChunk,
                 [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                   Counts& next = starts[chunk];
                   for (std::size_t i = begin; i < end; ++i)
                     sorted[next[digit(items[i])]++] = items[i];
                 });
    std::swap(items, sorted);
  }
}

}  // namespace paloc
