#include "raw_array.h"

#include <sys/mman.h>

namespace paloc {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kLarge = 2 * kHugePage;

std::align_val_t alignmentOf(std::size_t bytes) {
  return std::align_val_t{bytes >= kLarge ? kHugePage : 64};
}

}  // namespace

void* allocateRaw(std::size_t bytes) {
  void* const memory = ::operator new(bytes, alignmentOf(bytes));
  // A wish: without huge pages it is slower, and that is all.
  if (bytes >= kLarge) madvise(memory, bytes, MADV_HUGEPAGE);
  return memory;
}

void freeRaw(void* memory, std::size_t bytes) { ::operator delete(memory, alignmentOf(bytes)); }

}  // namespace paloc
