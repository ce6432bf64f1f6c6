#include "paloc/tools/ros_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "paloc/core/text.h"

namespace paloc {
namespace {

template <typename T>
T at(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

// A column of the points; without one, value() must not be asked.
struct Column {
  const RosPointField* field = nullptr;

  explicit operator bool() const { return field != nullptr; }
  bool isInteger() const { return field && field->datatype <= 6; }

  double value(const std::uint8_t* point) const {
    const std::uint8_t* p = point + field->offset;
    switch (field->datatype) {
      case 1:
        return at<std::int8_t>(p);
      case 2:
        return at<std::uint8_t>(p);
      case 3:
        return at<std::int16_t>(p);
      case 4:
        return at<std::uint16_t>(p);
      case 5:
        return at<std::int32_t>(p);
      case 6:
        return at<std::uint32_t>(p);
      case 7:
        return static_cast<double>(at<float>(p));
      default:
        return at<double>(p);
    }
  }
};

// Bytes of a datatype; 0 if there is no such type.
std::size_t bytesOf(std::uint8_t datatype) {
  constexpr std::array<std::size_t, 9> kBytes{0, 1, 1, 2, 2, 4, 4, 4, 8};
  return datatype < kBytes.size() ? kBytes[datatype] : 0;
}

Column find(const RosPointCloud2& message, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    for (const RosPointField& field : message.fields) {
      const std::size_t bytes = bytesOf(field.datatype);
      const bool fits = bytes > 0 && std::size_t{field.offset} + bytes <= message.point_step;
      if (field.name == name && fits) return {&field};
    }
  }
  return {};
}

bool hasRowsAsStated(const RosPointCloud2& m) {
  const std::uint64_t row = std::uint64_t{m.width} * m.point_step;
  const std::uint64_t last_row = m.height > 0 ? m.height - 1 : 0;
  if (m.height == 0 || m.width == 0) return true;
  return m.point_step > 0 && (m.height == 1 || row <= m.row_step) &&
         last_row * m.row_step + row <= m.data.size();
}

void add(PointCloud& cloud, double x, double y, double z, std::size_t& zero_dropped, bool& kept) {
  kept = std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
  ++cloud.points_read;
  if (!kept) {
    ++cloud.nonfinite_dropped;
  } else if (x == 0 && y == 0 && z == 0) {
    kept = false;
    ++zero_dropped;
  } else {
    cloud.points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
  }
}

std::uint16_t asRing(double value) {
  return static_cast<std::uint16_t>(std::isfinite(value) ? std::clamp(value, 0.0, 65535.0) : 0.0);
}

}  // namespace

std::optional<RosCloud> readPointCloud2(RosBytes bytes, const std::string& time_field,
                                        std::string& refusal) {
  const auto message = parsePointCloud2(bytes);
  if (!message) {
    refusal = "shorter or longer than they say";
    return std::nullopt;
  }
  if (message->big_endian) {
    refusal = "in big endian, which is not read";
    return std::nullopt;
  }
  const Column x = find(*message, {"x"}), y = find(*message, {"y"}), z = find(*message, {"z"});
  if (!x || !y || !z || x.isInteger() || y.isInteger() || z.isInteger()) {
    refusal = "without x, y, z as float32 or float64";
    return std::nullopt;
  }
  if (!hasRowsAsStated(*message)) {
    refusal = "with less data than width and height say";
    return std::nullopt;
  }
  const Column intensity = find(*message, {"intensity", "reflectivity", "i"});
  const Column ring = find(*message, {"ring", "line", "laser"});
  const Column time = time_field.empty()
                          ? find(*message, {"t", "time", "timestamp", "offset_time", "time_stamp"})
                          : find(*message, {time_field.c_str()});
  RosCloud result;
  result.stamp_ns = message->header.stamp_ns;
  result.frame = message->header.frame;
  PointCloud& cloud = result.cloud;
  if (time) cloud.time_field = time.field->name;
  cloud.time_is_integer = time.isInteger();
  for (std::size_t row = 0; row < message->height; ++row) {
    for (std::size_t col = 0; col < message->width; ++col) {
      const std::uint8_t* p =
          message->data.data() + row * message->row_step + col * message->point_step;
      bool kept = false;
      add(cloud, x.value(p), y.value(p), z.value(p), result.zero_dropped, kept);
      if (!kept) continue;
      if (time) cloud.time.push_back(time.value(p));
      if (intensity) cloud.intensity.push_back(static_cast<float>(intensity.value(p)));
      if (ring) cloud.ring.push_back(asRing(ring.value(p)));
    }
  }
  return result;
}

std::optional<RosCloud> readLivoxCustom(RosBytes bytes, std::string& refusal) {
  const auto message = parseLivoxCustom(bytes);
  if (!message) {
    refusal = "shorter or longer than they say";
    return std::nullopt;
  }
  RosCloud result;
  result.frame = message->header.frame;
  result.stamp_ns = message->header.stamp_ns;
  // The driver makes the stamp from the timebase by way of a double, which moves it by up to 120
  // ns.
  constexpr TimeNs kRounding = 1000;
  const auto timebase = static_cast<TimeNs>(message->timebase_ns);
  result.timebase_differs =
      timebase < result.stamp_ns - kRounding || timebase > result.stamp_ns + kRounding;
  if (!result.timebase_differs) result.stamp_ns = timebase;
  PointCloud& cloud = result.cloud;
  cloud.time_field = "offset_time";
  cloud.time_is_integer = true;
  for (std::size_t i = 0; i < message->points.size(); i += LivoxCustomMsg::kPointBytes) {
    const std::uint8_t* p = message->points.data() + i;
    const auto coordinate = [p](std::size_t axis) {
      return static_cast<double>(at<float>(p + 4 * (1 + axis)));
    };
    bool kept = false;
    add(cloud, coordinate(0), coordinate(1), coordinate(2), result.zero_dropped, kept);
    if (!kept) continue;
    cloud.time.push_back(at<std::uint32_t>(p));
    cloud.intensity.push_back(p[16]);
    cloud.ring.push_back(p[18]);
  }
  return result;
}

}  // namespace paloc
