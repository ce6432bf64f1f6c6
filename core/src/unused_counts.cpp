#include "paloc/core/unused_counts.h"

namespace paloc {

void UnusedCounts::add(const std::string& class_name, const std::string& label,
                       const std::string& reason, std::uint64_t count) {
  if (count > 0) counts_[{class_name, label, reason}] += count;
}

void UnusedCounts::merge(const UnusedCounts& other) {
  for (const auto& [key, count] : other.counts_) counts_[key] += count;
}

std::vector<UnusedCounts::Row> UnusedCounts::rows() const {
  std::vector<Row> result;
  for (const auto& [key, count] : counts_) {
    result.push_back({std::get<0>(key), std::get<1>(key), std::get<2>(key), count});
  }
  return result;
}

std::uint64_t UnusedCounts::total() const {
  std::uint64_t sum = 0;
  for (const auto& [key, count] : counts_) sum += count;
  return sum;
}

}  // namespace paloc
