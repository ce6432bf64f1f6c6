#pragma once

namespace paloc {

/// Asks for the line of the cache that the address lies in. GCC takes a function that does nothing
/// else for one without effect, and leaves out its calls: hence the empty statement, which it must
/// keep.
inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  __asm__ volatile("");
}

}  // namespace paloc
