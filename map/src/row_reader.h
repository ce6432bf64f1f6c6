#pragma once

#include <cstdint>
#include <vector>

#include "cloud_builder.h"
#include "text_rows.h"

namespace paloc {

/// Where the points of a binary file stand: records of equal size, one after the other.
struct RecordLayout {
  std::uint64_t first_byte = 0;
  std::uint64_t records = 0;
  std::size_t record_bytes = 0;
  std::vector<std::size_t> offsets;  ///< of each field in the record
  bool big_endian = false;
};

/// Reads the points of a binary file. The layout has been checked against the file's size.
PointCloud readRecords(const InputFile& file, const std::vector<CloudField>& fields,
                       const RecordLayout& layout);

/// Reads `rows` points of a text, one a line; `values_before[i]` values stand before field i.
/// Throws IoError (line, field) on anything that is not a number, and on too few or too many
/// values.
PointCloud readTextRows(const InputFile& file, const std::vector<CloudField>& fields,
                        const std::vector<std::size_t>& values_before, std::size_t values_per_row,
                        TextLines& lines, std::uint64_t rows);

}  // namespace paloc
