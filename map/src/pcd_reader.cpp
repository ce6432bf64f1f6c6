#include <algorithm>
#include <optional>

#include "cloud_readers.h"
#include "lzf.h"
#include "paloc/core/text.h"
#include "row_reader.h"
#include "text_rows.h"

/// Reads PCD files of the Point Cloud Library (format description of version 0.7).
namespace paloc {
namespace {

constexpr std::uint64_t kMaxHeaderBytes = 4 << 20;
constexpr std::uint64_t kMaxFieldValues = 1 << 20;  // of one point; a histogram has hundreds

struct PcdHeader {
  std::vector<CloudField> fields;
  std::vector<std::size_t> counts;  ///< values a field
  std::optional<std::uint64_t> width, height, points;
  std::string data;

  std::size_t recordBytes() const {
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < fields.size(); ++i) bytes += sizeOf(fields[i].type) * counts[i];
    return bytes;
  }
};

std::optional<ScalarType> scalarType(char kind, std::uint64_t bytes) {
  using enum ScalarType;
  switch (kind) {
    case 'I':
      return bytes == 1   ? std::optional(kInt8)
             : bytes == 2 ? std::optional(kInt16)
             : bytes == 4 ? std::optional(kInt32)
             : bytes == 8 ? std::optional(kInt64)
                          : std::nullopt;
    case 'U':
      return bytes == 1   ? std::optional(kUint8)
             : bytes == 2 ? std::optional(kUint16)
             : bytes == 4 ? std::optional(kUint32)
             : bytes == 8 ? std::optional(kUint64)
                          : std::nullopt;
    case 'F':
      return bytes == 4   ? std::optional(kFloat32)
             : bytes == 8 ? std::optional(kFloat64)
                          : std::nullopt;
    default:
      return std::nullopt;
  }
}

class PcdHeaderReader {
 public:
  PcdHeaderReader(const InputFile& file, TextLines& lines) : file_(file), lines_(lines) {}

  PcdHeader read() {
    while (header_.data.empty()) {
      std::string_view line;
      if (!lines_.next(line) || lines_.offset() > kMaxHeaderBytes) {
        file_.fail("its PCD header has no line 'DATA' (in its first 4 MB)");
      }
      const auto w = words(line);
      if (!w.empty() && !w[0].starts_with('#')) readLine(w);
    }
    makeFields();
    checkPoints();
    return std::move(header_);
  }

 private:
  void readLine(const std::vector<std::string_view>& w) {
    const std::string key(w[0].substr(0, 40));
    if (key == "VERSION" || key == "VIEWPOINT") return;
    if (w.size() < 2) fail(text("'", key, "' has no value"));
    if (key == "FIELDS" || key == "COLUMNS") {
      names_.assign(w.begin() + 1, w.end());
    } else if (key == "TYPE") {
      types_.assign(w.begin() + 1, w.end());
    } else if (key == "SIZE") {
      sizes_ = numbers(w);
    } else if (key == "COUNT") {
      counts_ = numbers(w);
    } else if (key == "WIDTH") {
      header_.width = numbers(w)[0];
    } else if (key == "HEIGHT") {
      header_.height = numbers(w)[0];
    } else if (key == "POINTS") {
      header_.points = numbers(w)[0];
    } else if (key == "DATA") {
      header_.data = std::string(w[1].substr(0, 40));
    } else {
      fail(text("'", key, "' is not known in a PCD header"));
    }
  }

  std::vector<std::uint64_t> numbers(const std::vector<std::string_view>& w) const {
    std::vector<std::uint64_t> result(w.size() - 1);
    for (std::size_t i = 1; i < w.size(); ++i) {
      if (!parseCount(w[i], result[i - 1])) {
        fail(text("'", w[i].substr(0, 40), "' is not a number"));
      }
    }
    return result;
  }

  void makeFields() {
    if (counts_.empty()) counts_.assign(names_.size(), 1);
    if (names_.empty() || sizes_.size() != names_.size() || types_.size() != names_.size() ||
        counts_.size() != names_.size()) {
      file_.fail("its PCD header needs FIELDS, SIZE and TYPE (and COUNT) of the same length");
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const auto type = types_[i].size() == 1 ? scalarType(types_[i][0], sizes_[i]) : std::nullopt;
      if (!type || counts_[i] > kMaxFieldValues) {
        file_.fail(text("its PCD field '", names_[i], "' has TYPE ", types_[i], ", SIZE ",
                        sizes_[i], ", COUNT ", counts_[i], ", which is not known"));
      }
      header_.fields.push_back({names_[i], *type});
      header_.counts.push_back(static_cast<std::size_t>(counts_[i]));
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (header_.counts[i] == 0) header_.fields[i].name.clear();  // takes no room: cannot be read
    }
  }

  void checkPoints() {
    const auto product = [this]() -> std::optional<std::uint64_t> {
      std::uint64_t result = 0;
      if (!header_.width || !header_.height) return std::nullopt;
      if (__builtin_mul_overflow(*header_.width, *header_.height, &result)) {
        file_.fail("its PCD header promises more points than any file can hold");
      }
      return result;
    }();
    if (!header_.points) header_.points = product;
    if (!header_.points) file_.fail("its PCD header has neither POINTS nor WIDTH and HEIGHT");
    if (product && *product != *header_.points) {
      file_.fail(text("its PCD header contradicts itself: POINTS ", *header_.points,
                      ", but WIDTH x HEIGHT is ", *product));
    }
  }

  [[noreturn]] void fail(const std::string& sentence) const {
    file_.fail(text("line ", lines_.lineNumber(), ": ", sentence));
  }

  const InputFile& file_;
  TextLines& lines_;
  PcdHeader header_;
  std::vector<std::string> names_, types_;
  std::vector<std::uint64_t> sizes_, counts_;
};

[[noreturn]] void failTooShort(const InputFile& file, std::uint64_t promised, std::uint64_t fit) {
  file.fail(text("its header promises ", promised, " points, but the file has room for ", fit));
}

PointCloud readBinary(const InputFile& file, const PcdHeader& header, std::uint64_t at,
                      const LoadOptions& options) {
  RecordLayout layout;
  layout.first_byte = at;
  layout.records = *header.points;
  layout.record_bytes = header.recordBytes();
  std::size_t offset = 0;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    layout.offsets.push_back(offset);
    offset += sizeOf(header.fields[i].type) * header.counts[i];
  }
  const std::uint64_t fit = (file.size() - at) / std::max<std::size_t>(layout.record_bytes, 1);
  if (layout.records > fit) failTooShort(file, layout.records, fit);
  if (layout.records < fit) {
    file.fail(text("its header promises ", layout.records, " points, but the file holds ", fit));
  }
  return readRecords(file, header.fields, layout, options);
}

// The unpacked block holds one field after the other, each for all points.
PointCloud readUnpacked(const InputFile& file, const PcdHeader& header,
                        const std::vector<std::byte>& block, const LoadOptions& options) {
  const CloudFields selection(header.fields, file);
  const auto points = static_cast<std::size_t>(*header.points);
  std::vector<std::size_t> first_byte;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    first_byte.push_back(offset);
    offset += sizeOf(header.fields[i].type) * header.counts[i] * points;
  }
  CloudBuilder builder(file, selection, points, options);
  for (std::size_t done = 0; done < points; done += CloudBuilder::kBlockRows) {
    const std::size_t rows = std::min(CloudBuilder::kBlockRows, points - done);
    for (std::size_t role = 0; role < kRoles; ++role) {
      if (!selection.has(static_cast<Role>(role))) continue;
      const std::size_t i = selection.index[role];
      const std::size_t stride = sizeOf(header.fields[i].type) * header.counts[i];
      readColumn({block.data() + first_byte[i] + done * stride, stride, header.fields[i].type},
                 rows, builder.column(static_cast<Role>(role)));
    }
    builder.addBlock(rows);
  }
  return builder.finish();
}

PointCloud readCompressed(const InputFile& file, const PcdHeader& header, std::uint64_t at,
                          const LoadOptions& options) {
  std::uint32_t sizes[2];  // packed, unpacked; little-endian
  if (file.size() - at < sizeof(sizes)) file.fail("ends before its compressed data");
  file.readAt(at, sizes, sizeof(sizes));
  at += sizeof(sizes);
  if (sizes[0] > file.size() - at) {
    file.fail(text("is truncated: ", sizes[0], " bytes of compressed data promised, ",
                   file.size() - at, " there"));
  }
  std::uint64_t expected = 0;
  if (__builtin_mul_overflow(*header.points, header.recordBytes(), &expected) ||
      expected != sizes[1] || sizes[1] > std::uint64_t{sizes[0]} * kLzfMaxRatio) {
    file.fail(text("its header promises ", *header.points,
                   " points, which do not fit its compressed data"));
  }
  MemoryBudget(options.memory_limit_bytes)
      .require(std::uint64_t{sizes[0]} + sizes[1], text(file.name(), ": its compressed data"));
  std::vector<std::byte> packed(sizes[0]);
  std::vector<std::byte> block(sizes[1]);
  file.readAt(at, packed.data(), packed.size());
  if (!unpackLzf(packed, block)) file.fail("its compressed data is damaged");
  return readUnpacked(file, header, block, options);
}

PointCloud readAscii(const InputFile& file, const PcdHeader& header, TextLines& lines,
                     const LoadOptions& options) {
  std::vector<std::size_t> values_before;
  std::size_t values = 0;
  for (const std::size_t count : header.counts) {
    values_before.push_back(values);
    values += count;
  }
  PointCloud cloud =
      readTextRows(file, header.fields, values_before, values, lines, *header.points, options);
  std::string_view line;
  while (lines.next(line)) {
    if (!words(line).empty()) {
      file.fail(text("line ", lines.lineNumber(), ": its header promises ", *header.points,
                     " points, but more lines follow"));
    }
  }
  return cloud;
}

}  // namespace

PointCloud readPcd(const InputFile& file, const LoadOptions& options) {
  TextLines lines(file, 0, 1);
  const PcdHeader header = PcdHeaderReader(file, lines).read();
  if (*header.points == 0) file.fail("has no points");
  PointCloud cloud;
  if (header.data == "ascii") {
    cloud = readAscii(file, header, lines, options);
  } else if (header.data == "binary") {
    cloud = readBinary(file, header, lines.offset(), options);
  } else if (header.data == "binary_compressed") {
    cloud = readCompressed(file, header, lines.offset(), options);
  } else {
    file.fail(
        text("its PCD data '", header.data, "' is not known (ascii, binary, binary_compressed)"));
  }
  cloud.format = text("PCD, ", header.data);
  return cloud;
}

}  // namespace paloc
