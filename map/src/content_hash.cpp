#include "content_hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "parallel_chunks.h"

namespace paloc {
namespace {

constexpr std::size_t kLanes = 4;
constexpr std::size_t kStride = kLanes * sizeof(std::uint64_t);
// Odd, with its bits in no order: pi in hexadecimal.
constexpr std::uint64_t kMultiplier = 0x3243f6a8885a308dULL;

std::uint64_t mixed(std::uint64_t value, std::uint64_t word) {
  return std::rotl(value ^ word, 29) * kMultiplier;
}

}  // namespace

std::uint64_t hashOf(const void* bytes, std::size_t size, std::uint64_t seed) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  std::array<std::uint64_t, kLanes> lanes{seed + 1, seed + 2, seed + 3, seed + 4};
  std::size_t left = size;
  for (; left >= kStride; left -= kStride, at += kStride) {
    std::array<std::uint64_t, kLanes> words;
    std::memcpy(words.data(), at, kStride);
    for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = mixed(lanes[i], words[i]);
  }
  std::array<std::uint64_t, kLanes> rest{};
  std::memcpy(rest.data(), at, left);
  std::uint64_t sum = size;
  for (std::size_t i = 0; i < kLanes; ++i) {
    lanes[i] = mixed(lanes[i], rest[i]);
    sum = mixed(sum, lanes[i] ^ lanes[i] >> 32);
  }
  return sum ^ sum >> 31;
}

std::uint64_t hashOfFile(const InputFile& file, tbb::task_arena& arena) {
  std::vector<std::uint64_t> hashes(chunkCount(file.size(), kHashChunk));
  forEachChunk(arena, file.size(), kHashChunk,
               [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                 thread_local std::vector<unsigned char> bytes(kHashChunk);
                 file.readAt(begin, bytes.data(), end - begin);
                 hashes[chunk] = hashOf(bytes.data(), end - begin);
               });
  return hashOf(hashes.data(), hashes.size() * sizeof(std::uint64_t));
}

}  // namespace paloc
