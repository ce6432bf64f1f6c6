#include "row_reader.h"
#include "paloc/core/text.h"

#include <algorithm>

namespace paloc {
namespace {

std::string rowsFound(std::uint64_t promised, std::uint64_t found) {
  return text("its header promises ", promised, " points, but the file ends after ", found);
}

void scaleRows(const RecordLayout& layout, std::size_t rows, CloudBuilder& builder) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double scale = layout.scale[axis], shift = layout.shift[axis];
    if (scale == 1 && shift == 0) continue;
    double* values = builder.column(static_cast<Role>(kX + axis));
    for (std::size_t i = 0; i < rows; ++i) values[i] = shift + scale * values[i];
  }
}

}  // namespace

RowParser::RowParser(const InputFile& file, const std::vector<CloudField>& fields,
                     const CloudFields& selection, const std::vector<std::size_t>& values_before,
                     std::size_t values_per_row)
    : file_(file), fields_(fields), selection_(selection), role_of_value_(values_per_row, kRoles) {
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (!selection_.has(static_cast<Role>(role))) continue;
    role_of_value_[values_before[selection_.index[role]]] = static_cast<Role>(role);
  }
}

void RowParser::parse(std::string_view line, std::uint64_t line_number, std::size_t row,
                      CloudBuilder& out) const {
  for (const Role role : role_of_value_) {
    const auto word = nextWord(line);
    if (word.empty()) fail(line_number, text("has fewer than ", valuesPerRow(), " values"));
    if (role == kRoles) continue;
    if (!parseNumber(word, out.column(role)[row])) {
      fail(line_number, text("'", word.substr(0, 40), "' is not a number (field '",
                             fields_[selection_.index[role]].name, "')"));
    }
  }
  if (!nextWord(line).empty()) fail(line_number, text("has more than ", valuesPerRow(), " values"));
}

void RowParser::fail(std::uint64_t line_number, const std::string& sentence) const {
  file_.fail(text("line ", line_number, ": ", sentence));
}

PointCloud readRecords(const InputFile& file, const std::vector<CloudField>& fields,
                       const RecordLayout& layout, const LoadOptions& options) {
  const CloudFields selection(fields, file);
  CloudBuilder builder(file, selection, layout.records, options);
  constexpr std::size_t kBlocksPerRead = 16;
  std::vector<std::byte> bytes(
      std::min<std::uint64_t>(layout.records, CloudBuilder::kBlockRows * kBlocksPerRead) *
      layout.record_bytes);
  for (std::uint64_t done = 0; done < layout.records;) {
    const auto here = static_cast<std::size_t>(
        std::min<std::uint64_t>(layout.records - done, CloudBuilder::kBlockRows * kBlocksPerRead));
    file.readAt(layout.first_byte + done * layout.record_bytes, bytes.data(),
                here * layout.record_bytes);
    for (std::size_t first = 0; first < here; first += CloudBuilder::kBlockRows) {
      const std::size_t rows = std::min(CloudBuilder::kBlockRows, here - first);
      for (std::size_t role = 0; role < kRoles; ++role) {
        if (!selection.has(static_cast<Role>(role))) continue;
        const std::size_t field = selection.index[role];
        const auto* first_value =
            bytes.data() + first * layout.record_bytes + layout.offsets[field];
        readColumn({first_value, layout.record_bytes, fields[field].type, layout.big_endian}, rows,
                   builder.column(static_cast<Role>(role)));
      }
      scaleRows(layout, rows, builder);
      builder.addBlock(rows);
    }
    done += here;
  }
  return builder.finish();
}

PointCloud readTextRows(const InputFile& file, const std::vector<CloudField>& fields,
                        const std::vector<std::size_t>& values_before, std::size_t values_per_row,
                        TextLines& lines, std::uint64_t rows, const LoadOptions& options) {
  // Two bytes a value (a digit and a blank or line end) are the least, the last end may be missing.
  const std::uint64_t left = file.size() - lines.offset();
  if (rows > (left + 1) / 2 / std::max<std::size_t>(values_per_row, 1)) {
    file.fail(text("its header promises ", rows, " points, but only ", left, " bytes follow"));
  }
  const CloudFields selection(fields, file);
  CloudBuilder builder(file, selection, rows, options);
  const RowParser parser(file, fields, selection, values_before, values_per_row);
  std::size_t in_block = 0;
  for (std::uint64_t row = 0; row < rows; ++row) {
    std::string_view line;
    if (!lines.next(line)) file.fail(rowsFound(rows, row));
    parser.parse(line, lines.lineNumber(), in_block, builder);
    if (++in_block == CloudBuilder::kBlockRows) {
      builder.addBlock(in_block);
      in_block = 0;
    }
  }
  builder.addBlock(in_block);
  return builder.finish();
}

}  // namespace paloc
