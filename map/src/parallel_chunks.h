#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

namespace paloc {

inline std::size_t chunkCount(std::size_t size, std::size_t chunk) {
  return (size + chunk - 1) / chunk;
}

/// Calls body(chunk_index, begin, end) for the fixed chunks of [0, size). The borders of the chunks
/// do not depend on the number of threads: sums that are kept per chunk and added in the order of
/// the chunks give the same bytes on any number of threads.
template <typename Body>
void forEachChunk(tbb::task_arena& arena, std::size_t size, std::size_t chunk, const Body& body) {
  const std::size_t chunks = chunkCount(size, chunk);
  const auto run = [&](std::size_t index) {
    body(index, index * chunk, std::min(size, (index + 1) * chunk));
  };
  if (chunks <= 1 || arena.max_concurrency() == 1) {
    for (std::size_t index = 0; index < chunks; ++index) run(index);
    return;
  }
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t index = range.begin(); index != range.end(); ++index) run(index);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace paloc
