#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "cloud_readers.h"
#include "paloc/core/errors.h"

namespace paloc::test {

/// Reads bytes as loadCloud would read a file of this name, whole and thinned. Whatever they are,
/// the answer is a cloud or an IoError.
inline int fuzzReader(const std::uint8_t* data, std::size_t size, const std::string& name) {
  // What a few bytes may ask for bounds the time that they take, too.
  constexpr std::uint64_t kMemory = 16 << 20;
  InputFile::Pieces pieces;
  for (std::size_t at = 0; at < size; at += InputFile::kPieceBytes) {
    const auto* from = reinterpret_cast<const std::byte*>(data) + at;
    pieces.emplace_back(from, from + std::min(InputFile::kPieceBytes, size - at));
  }
  const InputFile file(name, std::move(pieces));
  for (const double voxel_m : {0.0, 0.5}) {
    try {
      const PointCloud cloud = readCloud(file, {.voxel_m = voxel_m, .memory_limit_bytes = kMemory});
      if (cloud.empty() || !cloud.origin.allFinite()) __builtin_trap();
    } catch (const IoError&) {  // refused
    }
  }
  return 0;
}

}  // namespace paloc::test
