#include "memory_budget.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"

namespace paloc {
namespace {

std::optional<std::uint64_t> numberIn(const std::string& file) {
  std::ifstream in(file);
  std::uint64_t value = 0;
  return in >> value ? std::optional(value) : std::nullopt;  // "max": no limit
}

std::optional<std::uint64_t> machineAvailable() {
  std::ifstream in("/proc/meminfo");
  std::string key, unit;
  std::uint64_t kilobytes = 0;
  while (in >> key >> kilobytes) {
    if (key == "MemAvailable:") return kilobytes * 1024;
    std::getline(in, unit);
  }
  return std::nullopt;
}

// The control group, version 2, that a container shows as its root.
std::optional<std::uint64_t> groupAvailable() {
  const auto limit = numberIn("/sys/fs/cgroup/memory.max");
  const auto used = numberIn("/sys/fs/cgroup/memory.current");
  if (!limit || !used) return std::nullopt;
  return *limit > *used ? *limit - *used : 0;
}

std::string gigabytes(std::uint64_t bytes) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.2f GB", static_cast<double>(bytes) * 1e-9);
  return buffer;
}

}  // namespace

std::uint64_t availableMemory() {
  constexpr auto kUnknown = std::numeric_limits<std::uint64_t>::max();
  return std::min(machineAvailable().value_or(kUnknown), groupAvailable().value_or(kUnknown));
}

MemoryBudget::MemoryBudget(std::uint64_t limit_bytes)
    : bytes_(limit_bytes > 0 ? limit_bytes : availableMemory()), of_machine_(limit_bytes == 0) {}

void MemoryBudget::require(std::uint64_t bytes, const std::string& what) const {
  if (bytes <= bytes_) return;
  throw IoError(text(what, " needs ", gigabytes(bytes), " of memory, but ",
                     of_machine_ ? "the machine has " : "the limit is ", gigabytes(bytes_),
                     of_machine_ ? " free" : ""));
}

}  // namespace paloc
