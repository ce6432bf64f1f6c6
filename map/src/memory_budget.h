#pragma once

#include <cstdint>
#include <string>

namespace paloc {

/// Memory that may be taken. It is asked before memory is taken that a file makes necessary, so
/// that a file too big is refused in a sentence instead of by the system's killer.
class MemoryBudget {
 public:
  /// `limit_bytes` = 0: what the machine has free, now.
  explicit MemoryBudget(std::uint64_t limit_bytes = 0);

  std::uint64_t bytes() const { return bytes_; }

  /// Throws IoError, "WHAT needs ... GB of memory, but ...", unless `bytes` are within it.
  void require(std::uint64_t bytes, const std::string& what) const;

 private:
  std::uint64_t bytes_;
  bool of_machine_;
};

/// What can be taken without swapping (bytes): Linux' MemAvailable, or what the process's control
/// group leaves, if that is less. The highest number if neither can be told.
std::uint64_t availableMemory();

}  // namespace paloc
