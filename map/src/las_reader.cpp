#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "cloud_readers.h"
#include "paloc/core/text.h"
#include "row_reader.h"

/// Reads LAS files (ASPRS, "LAS Specification 1.4 - R15", table 3 and tables 7 to 17).
namespace paloc {
namespace {

constexpr std::size_t kOldHeaderBytes = 227, kHeaderBytes13 = 235, kHeaderBytes14 = 375;
constexpr std::uint8_t kCompressedBits = 0xc0;  // LASzip marks its point formats so
constexpr std::uint16_t kInternalWaveforms = 2;

// Of the point formats 0 to 10: the shortest record, and where the GPS time stands (0: nowhere).
struct PointFormat {
  std::uint16_t bytes;
  std::uint16_t time_at;
};
constexpr std::array<PointFormat, 11> kPointFormats{{{20, 0},
                                                     {28, 20},
                                                     {26, 0},
                                                     {34, 20},
                                                     {57, 20},
                                                     {63, 20},
                                                     {30, 22},
                                                     {36, 22},
                                                     {38, 22},
                                                     {59, 22},
                                                     {67, 22}}};

struct LasHeader {
  std::uint8_t minor = 0, point_format = 0;
  std::uint16_t encoding = 0, header_bytes = 0, record_bytes = 0;
  std::uint32_t points_at = 0;
  std::uint64_t points = 0;
  std::uint64_t points_end = 0;  ///< where something else follows; 0: at the file's end
  std::array<double, 3> scale{}, offset{};
};

class HeaderReader {
 public:
  explicit HeaderReader(const InputFile& file) : file_(file) {
    static_assert(std::endian::native == std::endian::little);
    bytes_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), kHeaderBytes14)));
    file.readAt(0, bytes_.data(), bytes_.size());
  }

  LasHeader read() const {
    LasHeader h;
    if (bytes_.size() < kOldHeaderBytes) file_.fail("ends within its LAS header");
    const auto major = at<std::uint8_t>(24);
    h.minor = at<std::uint8_t>(25);
    if (major != 1 || h.minor > 4) {
      file_.fail(
          text("is LAS ", int{major}, ".", int{h.minor}, ", which is not known (1.0 to 1.4)"));
    }
    h.encoding = at<std::uint16_t>(6);
    h.header_bytes = at<std::uint16_t>(94);
    h.points_at = at<std::uint32_t>(96);
    h.point_format = at<std::uint8_t>(104);
    h.record_bytes = at<std::uint16_t>(105);
    h.points = at<std::uint32_t>(107);
    h.scale = {at<double>(131), at<double>(139), at<double>(147)};
    h.offset = {at<double>(155), at<double>(163), at<double>(171)};
    readLater(h);
    return h;
  }

 private:
  void readLater(LasHeader& h) const {
    const std::size_t needed = h.minor == 4   ? kHeaderBytes14
                               : h.minor == 3 ? kHeaderBytes13
                                              : kOldHeaderBytes;
    if (h.header_bytes < needed || bytes_.size() < needed) {
      file_.fail(text("its LAS header of ", h.header_bytes, " bytes is too short for version 1.",
                      int{h.minor}, " (", needed, ")"));
    }
    if (h.minor >= 3 && (h.encoding & kInternalWaveforms) != 0) {
      h.points_end = at<std::uint64_t>(227);
    }
    if (h.minor < 4) return;
    const auto count = at<std::uint64_t>(247);
    if (count != 0) h.points = count;
    if (at<std::uint32_t>(243) > 0) {
      const auto extended = at<std::uint64_t>(235);
      h.points_end = h.points_end == 0 ? extended : std::min(h.points_end, extended);
    }
  }

  template <typename T>
  T at(std::size_t offset) const {
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }

  const InputFile& file_;
  std::vector<std::byte> bytes_;
};

std::string number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

void checkScale(const InputFile& file, const LasHeader& h) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    if (!std::isfinite(h.scale[axis]) || !(h.scale[axis] > 0)) {
      file.fail(text("its scale of ", name, " is ", number(h.scale[axis]),
                     ", which must be a positive number"));
    }
    if (!std::isfinite(h.offset[axis])) {
      file.fail(text("its offset of ", name, " is ", number(h.offset[axis])));
    }
  }
}

void checkPoints(const InputFile& file, const LasHeader& h) {
  if (h.points == 0) file.fail("has no points");
  const std::uint16_t least = kPointFormats[h.point_format].bytes;
  if (h.record_bytes < least) {
    file.fail(text("its records of ", h.record_bytes, " bytes are too short for point format ",
                   int{h.point_format}, " (", least, ")"));
  }
  std::uint64_t end = file.size();
  if (h.points_end > h.points_at) end = std::min(end, h.points_end);
  if (h.points_at < h.header_bytes || h.points_at > end) {
    file.fail(text("its points are said to begin at byte ", h.points_at, ", which cannot be"));
  }
  const std::uint64_t fit = (end - h.points_at) / h.record_bytes;
  if (h.points > fit) {
    file.fail(text("its header promises ", h.points, " points, but the file has room for ", fit));
  }
  if (h.points < fit) {
    file.fail(text("its header promises ", h.points, " points, but the file holds ", fit));
  }
}

}  // namespace

PointCloud readLas(const InputFile& file, const LoadOptions& options) {
  const LasHeader h = HeaderReader(file).read();
  if ((h.point_format & kCompressedBits) != 0) {
    file.fail("is compressed (LAZ), which is not read: unpack it to LAS first");
  }
  if (h.point_format >= kPointFormats.size()) {
    file.fail(text("its point format ", int{h.point_format}, " is not known (0 to 10)"));
  }
  checkScale(file, h);
  checkPoints(file, h);
  using enum ScalarType;
  std::vector<CloudField> fields{
      {"x", kInt32}, {"y", kInt32}, {"z", kInt32}, {"intensity", kUint16}};
  RecordLayout layout;
  layout.offsets = {0, 4, 8, 12};
  if (const std::uint16_t time_at = kPointFormats[h.point_format].time_at; time_at > 0) {
    fields.push_back({"gps_time", kFloat64});
    layout.offsets.push_back(time_at);
  }
  layout.first_byte = h.points_at;
  layout.records = h.points;
  layout.record_bytes = h.record_bytes;
  layout.scale = h.scale;
  layout.shift = h.offset;
  PointCloud cloud = readRecords(file, fields, layout, options);
  cloud.format = text("LAS 1.", int{h.minor}, ", point format ", int{h.point_format});
  return cloud;
}

}  // namespace paloc
