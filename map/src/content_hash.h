#pragma once

#include <tbb/task_arena.h>

#include <cstddef>
#include <cstdint>

#include "input_file.h"

namespace paloc {

/// A number that two contents share by chance only (64 bits). It tells a changed or damaged file;
/// it is no protection against one that was forged.
std::uint64_t hashOf(const void* bytes, std::size_t size, std::uint64_t seed = 0);

/// That of a content read chunk by chunk of kHashChunk bytes (the last may be shorter): the hash
/// of the chunks' hashes.
constexpr std::size_t kHashChunk = 1U << 20;

/// That of a whole file. Several gigabytes a second where the file is in the system's cache.
std::uint64_t hashOfFile(const InputFile& file, tbb::task_arena& arena);

}  // namespace paloc
