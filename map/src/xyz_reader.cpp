#include <algorithm>
#include <cctype>
#include <optional>

#include "cloud_readers.h"
#include "paloc/core/text.h"
#include "row_reader.h"
#include "text_rows.h"

/// Reads text with one point a line. The first line that is no comment may name the columns (as
/// CloudCompare's "//X,Y,Z,Intensity" does) or promise the number of points (as PTS files do).
/// Without names the columns are x y z, then an intensity where there are four or seven of them
/// (x y z i, x y z i r g b); others are not looked at.
namespace paloc {
namespace {

constexpr std::size_t kMaxColumns = 256;

bool isSeparator(char c) { return c == ',' || c == ';' || c == '\t'; }

// The line with blanks between the values, whatever separates them.
std::string_view withBlanks(std::string_view line, std::string& buffer) {
  buffer.assign(line);
  std::replace_if(buffer.begin(), buffer.end(), isSeparator, ' ');
  return buffer;
}

std::string_view withoutCommentMark(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t#%/!");
  return first == std::string_view::npos ? std::string_view{} : line.substr(first);
}

bool isComment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return true;
  const char c = line[first];
  return c == '#' || c == '%' || c == '!' || line.substr(first).starts_with("//");
}

// A name without its unit: "X[m]" and "x (m)" are x.
std::string plainName(std::string_view word) {
  std::string name(word.substr(0, word.find_first_of("[(")));
  std::erase(name, '"');
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name == "i" ? "intensity" : name;
}

// The names of the columns, if the line is one of names: x, y and z among them.
std::vector<std::string> namesIn(std::string_view line) {
  std::string buffer;
  std::vector<std::string> names;
  for (const auto word : words(withBlanks(withoutCommentMark(line), buffer))) {
    if (std::string name = plainName(word); !name.empty()) names.push_back(std::move(name));
  }
  for (const char* axis : {"x", "y", "z"}) {
    if (std::find(names.begin(), names.end(), axis) == names.end()) return {};
  }
  return names;
}

class XyzReader {
 public:
  XyzReader(const InputFile& file, const LoadOptions& options)
      : file_(file), options_(options), lines_(file, 0, 1) {}

  PointCloud read() {
    std::string_view line = firstRow();
    const auto fields = fieldsOf(line);
    std::vector<std::size_t> values_before(fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) values_before[i] = i;
    const CloudFields selection(fields, file_);
    const RowParser parser(file_, fields, selection, values_before, fields.size());
    CloudBuilder builder(file_, selection, expectedRows(line), options_);
    std::size_t in_block = 0;
    std::uint64_t rows = 0;
    do {
      if (isComment(line)) continue;
      parser.parse(plain(line), lines_.lineNumber(), in_block, builder);
      ++rows;
      if (++in_block < CloudBuilder::kBlockRows) continue;
      builder.addBlock(in_block);
      in_block = 0;
    } while (lines_.next(line));
    builder.addBlock(in_block);
    if (promised_ && *promised_ != rows) {
      file_.fail(text("its first line promises ", *promised_, " points, but it holds ", rows));
    }
    PointCloud cloud = builder.finish();
    cloud.format = "XYZ text";
    return cloud;
  }

 private:
  // The first line of values; what stands before it is understood or skipped.
  std::string_view firstRow() {
    std::string_view line;
    while (lines_.next(line)) {
      if (names_.empty() && !promised_) {
        names_ = namesIn(line);
        if (!names_.empty()) continue;
      }
      if (isComment(line)) continue;
      const auto w = words(plain(line));
      double value = 0;
      if (w.size() == 1 && !promised_ && names_.empty()) {
        std::uint64_t count = 0;
        if (!parseCount(w[0], count)) fail(text("'", w[0].substr(0, 40), "' is no point"));
        promised_ = count;
        continue;
      }
      if (w.empty() || !parseNumber(w[0], value)) {
        fail(text("begins with '", w.empty() ? line.substr(0, 1) : w[0].substr(0, 40),
                  "', which is no number, and names no columns x, y and z"));
      }
      return line;
    }
    file_.fail("has no points");
  }

  std::vector<CloudField> fieldsOf(std::string_view line) {
    const std::size_t columns = words(plain(line)).size();
    std::vector<CloudField> fields;
    for (const std::string& name : names_) fields.push_back({name, ScalarType::kFloat64});
    if (!fields.empty()) return fields;
    if (columns < 3) fail(text("has ", columns, " values: a point needs x, y and z"));
    if (columns > kMaxColumns) fail(text("has more than ", kMaxColumns, " values"));
    const char* kNames[] = {"x", "y", "z", "intensity"};
    for (std::size_t i = 0; i < columns; ++i) {
      const bool known = i < 3 || (i == 3 && (columns == 4 || columns == 7));
      fields.push_back({known ? kNames[i] : "", ScalarType::kFloat64});
    }
    return fields;
  }

  std::string_view plain(std::string_view line) {
    if (line.find(',') != std::string_view::npos && line.find(';') != std::string_view::npos) {
      fail("has commas and semicolons: decimals need a point, and columns one separator");
    }
    return withBlanks(line, buffer_);
  }

  // Lines are about as long as the first.
  std::uint64_t expectedRows(std::string_view line) const {
    const std::uint64_t rows = (file_.size() - lines_.offset()) / (line.size() + 1) + 1;
    return promised_ ? std::min(*promised_, 2 * rows) : rows;
  }

  [[noreturn]] void fail(const std::string& sentence) const {
    file_.fail(text("line ", lines_.lineNumber(), ": ", sentence));
  }

  const InputFile& file_;
  const LoadOptions& options_;
  TextLines lines_;
  std::vector<std::string> names_;
  std::optional<std::uint64_t> promised_;
  std::string buffer_;
};

}  // namespace

PointCloud readXyz(const InputFile& file, const LoadOptions& options) {
  return XyzReader(file, options).read();
}

}  // namespace paloc
