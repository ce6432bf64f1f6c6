#include <optional>
#include <utility>

#include "cloud_readers.h"
#include "paloc/core/text.h"
#include "row_reader.h"
#include "text_rows.h"

/// Reads the vertices of a PLY file (the format of Greg Turk's "The PLY Polygon File Format",
/// 1994).
namespace paloc {
namespace {

constexpr std::uint64_t kMaxHeaderBytes = 4 << 20;

struct Property {
  CloudField field;                      ///< of a list: the type of its items
  std::optional<ScalarType> list_count;  ///< set if it is a list: the type of its length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  bool hasList() const {
    for (const auto& p : properties) {
      if (p.list_count) return true;
    }
    return false;
  }
  std::size_t recordBytes() const {  // without lists
    std::size_t bytes = 0;
    for (const auto& p : properties) bytes += sizeOf(p.field.type);
    return bytes;
  }
};

enum class Encoding { kAscii, kLittleEndian, kBigEndian };

std::optional<ScalarType> typeNamed(std::string_view name) {
  using enum ScalarType;
  static constexpr std::pair<std::string_view, ScalarType> kNames[] = {
      {"char", kInt8},      {"int8", kInt8},      {"uchar", kUint8},   {"uint8", kUint8},
      {"short", kInt16},    {"int16", kInt16},    {"ushort", kUint16}, {"uint16", kUint16},
      {"int", kInt32},      {"int32", kInt32},    {"uint", kUint32},   {"uint32", kUint32},
      {"int64", kInt64},    {"uint64", kUint64},  {"float", kFloat32}, {"float32", kFloat32},
      {"double", kFloat64}, {"float64", kFloat64}};
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  return std::nullopt;
}

class PlyHeader {
 public:
  PlyHeader(const InputFile& file, TextLines& lines) : file_(file), lines_(lines) {
    std::string_view line;
    lines_.next(line);  // "ply": checked by who chose the format
    while (nextLine(line)) {
      const auto w = words(line);
      if (w.empty() || w[0] == "comment" || w[0] == "obj_info") continue;
      if (w[0] == "format") {
        readFormat(w);
      } else if (w[0] == "element") {
        readElement(w);
      } else if (w[0] == "property") {
        readProperty(w);
      } else {
        fail(text("'", w[0].substr(0, 40), "' is not known in a PLY header"));
      }
    }
    if (!encoding_) file_.fail("its PLY header has no line 'format'");
  }

  Encoding encoding() const { return *encoding_; }
  const std::vector<Element>& elements() const { return elements_; }

 private:
  // False at "end_header".
  bool nextLine(std::string_view& line) {
    if (!lines_.next(line) || lines_.offset() > kMaxHeaderBytes) {
      file_.fail("its PLY header has no 'end_header' (in its first 4 MB)");
    }
    return line.substr(0, line.find_last_not_of(" \t") + 1) != "end_header";
  }

  void readFormat(const std::vector<std::string_view>& w) {
    if (w.size() < 2) fail("the format is missing");
    if (w[1] == "ascii") {
      encoding_ = Encoding::kAscii;
    } else if (w[1] == "binary_little_endian") {
      encoding_ = Encoding::kLittleEndian;
    } else if (w[1] == "binary_big_endian") {
      encoding_ = Encoding::kBigEndian;
    } else {
      fail(text("format '", w[1].substr(0, 40), "' is not known"));
    }
  }

  void readElement(const std::vector<std::string_view>& w) {
    Element element;
    if (w.size() != 3 || !parseCount(w[2], element.count))
      fail("an element needs a name and a count");
    element.name = w[1];
    elements_.push_back(std::move(element));
  }

  void readProperty(const std::vector<std::string_view>& w) {
    if (elements_.empty()) fail("a property before the first element");
    const bool list = w.size() == 5 && w[1] == "list";
    if (!list && w.size() != 3) fail("a property needs a type and a name");
    Property property;
    property.field = {std::string(w.back()), readType(w[w.size() - 2])};
    if (list) property.list_count = readType(w[2]);
    elements_.back().properties.push_back(std::move(property));
  }

  ScalarType readType(std::string_view name) const {
    const auto type = typeNamed(name);
    if (!type) fail(text("type '", name.substr(0, 40), "' is not known"));
    return *type;
  }

  [[noreturn]] void fail(const std::string& sentence) const {
    file_.fail(text("line ", lines_.lineNumber(), ": ", sentence));
  }

  const InputFile& file_;
  TextLines& lines_;
  std::optional<Encoding> encoding_;
  std::vector<Element> elements_;
};

[[noreturn]] void failTooShort(const InputFile& file, const Element& element, std::uint64_t fit) {
  file.fail(text("its header promises ", element.count, " of element '", element.name,
                 "', but the file has room for ", fit));
}

// The byte after a binary element that stands before the vertices.
std::uint64_t skipBinary(const InputFile& file, const Element& element, std::uint64_t at,
                         bool big_endian) {
  if (!element.hasList()) {
    const std::size_t bytes = element.recordBytes();
    const std::uint64_t fit = bytes == 0 ? element.count : (file.size() - at) / bytes;
    if (element.count > fit) failTooShort(file, element, fit);
    return at + element.count * bytes;
  }
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const auto& p : element.properties) {
      double items = 1;
      if (p.list_count) {
        std::byte length[8];
        file.readAt(at, length, sizeOf(*p.list_count));
        readColumn({length, 0, *p.list_count, big_endian}, 1, &items);
        at += sizeOf(*p.list_count);
      }
      const double bytes = items * static_cast<double>(sizeOf(p.field.type));
      if (!(bytes >= 0) || bytes > static_cast<double>(file.size() - at))
        failTooShort(file, element, i);
      at += static_cast<std::uint64_t>(bytes);
    }
  }
  return at;
}

PointCloud readBinaryVertices(const InputFile& file, const Element& vertex,
                              const std::vector<CloudField>& fields, std::uint64_t at,
                              bool big_endian, bool last, const LoadOptions& options) {
  RecordLayout layout;
  layout.first_byte = at;
  layout.records = vertex.count;
  layout.record_bytes = vertex.recordBytes();
  layout.big_endian = big_endian;
  std::size_t offset = 0;
  for (const auto& field : fields) {
    layout.offsets.push_back(offset);
    offset += sizeOf(field.type);
  }
  if (layout.record_bytes == 0) file.fail("its vertices have no properties");
  const std::uint64_t fit = (file.size() - at) / layout.record_bytes;
  if (vertex.count > fit) failTooShort(file, vertex, fit);
  if (last && vertex.count < fit) {
    file.fail(text("its header promises ", vertex.count, " points, but the file holds ", fit));
  }
  return readRecords(file, fields, layout, options);
}

std::string formatName(const PlyHeader& header) {
  switch (header.encoding()) {
    case Encoding::kAscii:
      return "PLY, ascii";
    case Encoding::kLittleEndian:
      return "PLY, binary_little_endian";
    case Encoding::kBigEndian:
      return "PLY, binary_big_endian";
  }
  return "PLY";
}

PointCloud readTextVertices(const InputFile& file, const Element& vertex,
                            const std::vector<CloudField>& fields, TextLines& lines, bool last,
                            const LoadOptions& options) {
  std::vector<std::size_t> values_before(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) values_before[i] = i;
  PointCloud cloud =
      readTextRows(file, fields, values_before, fields.size(), lines, vertex.count, options);
  std::string_view line;
  while (last && lines.next(line)) {
    if (!words(line).empty()) {
      file.fail(text("line ", lines.lineNumber(), ": its header promises ", vertex.count,
                     " points, but more lines follow"));
    }
  }
  return cloud;
}

}  // namespace

PointCloud readPly(const InputFile& file, const LoadOptions& options) {
  TextLines lines(file, 0, 1);
  const PlyHeader header(file, lines);
  const bool ascii = header.encoding() == Encoding::kAscii;
  const bool big_endian = header.encoding() == Encoding::kBigEndian;
  std::uint64_t at = lines.offset();
  for (const auto& element : header.elements()) {
    if (element.name != "vertex") {
      std::string_view line;
      for (std::uint64_t i = 0; ascii && i < element.count; ++i) {
        if (!lines.next(line)) failTooShort(file, element, i);
      }
      if (!ascii) at = skipBinary(file, element, at, big_endian);
      continue;
    }
    if (element.hasList()) file.fail("its vertices have a list property, which is not supported");
    std::vector<CloudField> fields;
    for (const auto& p : element.properties) fields.push_back(p.field);
    const bool last = &element == &header.elements().back();
    PointCloud cloud =
        ascii ? readTextVertices(file, element, fields, lines, last, options)
              : readBinaryVertices(file, element, fields, at, big_endian, last, options);
    cloud.format = formatName(header);
    return cloud;
  }
  file.fail("its PLY header has no element 'vertex'");
}

}  // namespace paloc
