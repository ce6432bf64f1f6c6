#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "paloc/core/export.h"

namespace paloc {

/// Counts every observation (or part of one) that was not used, so that nothing is dropped in
/// silence. Ordered by name: the same input prints the same table.
class PALOC_EXPORT UnusedCounts {
 public:
  struct Row {
    std::string class_name;  ///< "CObservationIMU"
    std::string label;       ///< the sensor's label in the recording
    std::string reason;      ///< "time goes backwards"
    std::uint64_t count = 0;
  };

  void add(const std::string& class_name, const std::string& label, const std::string& reason,
           std::uint64_t count = 1);
  void merge(const UnusedCounts& other);
  std::vector<Row> rows() const;
  std::uint64_t total() const;

 private:
  std::map<std::tuple<std::string, std::string, std::string>, std::uint64_t> counts_;
};

}  // namespace paloc
