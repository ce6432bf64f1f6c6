#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
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
  /// A coordinate is shift + scale * value.
  std::array<double, 3> scale{1, 1, 1}, shift{0, 0, 0};
};

/// Reads the points of a binary file. The layout has been checked against the file's size.
PointCloud readRecords(const InputFile& file, const std::vector<CloudField>& fields,
                       const RecordLayout& layout, const LoadOptions& options);

/// Reads the values of a line of text into a row of a builder's block.
class RowParser {
 public:
  /// `values_before[i]` values stand before field i.
  RowParser(const InputFile& file, const std::vector<CloudField>& fields,
            const CloudFields& selection, const std::vector<std::size_t>& values_before,
            std::size_t values_per_row);

  /// Throws IoError (line, field) on anything that is not a number, and on too few or too many
  /// values.
  void parse(std::string_view line, std::uint64_t line_number, std::size_t row,
             CloudBuilder& out) const;

 private:
  std::string valuesPerRow() const { return std::to_string(role_of_value_.size()); }
  [[noreturn]] void fail(std::uint64_t line_number, const std::string& sentence) const;

  const InputFile& file_;
  const std::vector<CloudField>& fields_;
  const CloudFields& selection_;
  std::vector<Role> role_of_value_;  ///< kRoles: a value that nobody asks for
};

/// Reads `rows` points of a text, one a line; `values_before[i]` values stand before field i.
/// Throws IoError (line, field) on anything that is not a number, and on too few or too many
/// values.
PointCloud readTextRows(const InputFile& file, const std::vector<CloudField>& fields,
                        const std::vector<std::size_t>& values_before, std::size_t values_per_row,
                        TextLines& lines, std::uint64_t rows, const LoadOptions& options);

}  // namespace paloc
