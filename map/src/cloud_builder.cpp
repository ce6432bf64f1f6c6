#include "cloud_builder.h"
#include "paloc/core/text.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <string_view>

namespace paloc {
namespace {

// Further from zero than this, single precision would lose a tenth of a millimetre.
constexpr double kFarFromZero_m = 1000.0;
constexpr double kOriginGrid_m = 100.0;

std::string plainName(std::string_view name) {
  constexpr std::string_view kPrefix = "scalar_";
  if (name.starts_with(kPrefix)) name.remove_prefix(kPrefix.size());
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// The first of `names` that is among the fields.
std::size_t find(const std::vector<CloudField>& fields,
                 std::initializer_list<std::string_view> names) {
  for (const auto name : names) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (plainName(fields[i].name) == name) return i;
    }
  }
  return CloudFields::kAbsent;
}

template <std::size_t kSize>
struct BitsOf;
template <>
struct BitsOf<1> {
  using type = std::uint8_t;
};
template <>
struct BitsOf<2> {
  using type = std::uint16_t;
};
template <>
struct BitsOf<4> {
  using type = std::uint32_t;
};
template <>
struct BitsOf<8> {
  using type = std::uint64_t;
};

std::uint8_t swapped(std::uint8_t v) { return v; }
std::uint16_t swapped(std::uint16_t v) { return __builtin_bswap16(v); }
std::uint32_t swapped(std::uint32_t v) { return __builtin_bswap32(v); }
std::uint64_t swapped(std::uint64_t v) { return __builtin_bswap64(v); }

template <typename T, bool kSwap>
void readTyped(const std::byte* from, std::size_t stride, std::size_t count, double* out) {
  for (std::size_t i = 0; i < count; ++i, from += stride) {
    typename BitsOf<sizeof(T)>::type bits;
    std::memcpy(&bits, from, sizeof(bits));
    if constexpr (kSwap) bits = swapped(bits);
    out[i] = static_cast<double>(std::bit_cast<T>(bits));
  }
}

template <typename T>
void readAs(const Column& c, std::size_t count, double* out) {
  static_assert(std::endian::native == std::endian::little);
  if (c.big_endian) {
    readTyped<T, true>(c.first, c.stride, count, out);
  } else {
    readTyped<T, false>(c.first, c.stride, count, out);
  }
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::uint16_t asRing(double value) {
  constexpr double kMax = std::numeric_limits<std::uint16_t>::max();
  return std::isfinite(value) ? static_cast<std::uint16_t>(std::clamp(value, 0.0, kMax))
                              : std::uint16_t{0};
}

}  // namespace

std::size_t sizeOf(ScalarType type) {
  switch (type) {
    case ScalarType::kInt8:
    case ScalarType::kUint8:
      return 1;
    case ScalarType::kInt16:
    case ScalarType::kUint16:
      return 2;
    case ScalarType::kInt32:
    case ScalarType::kUint32:
    case ScalarType::kFloat32:
      return 4;
    case ScalarType::kInt64:
    case ScalarType::kUint64:
    case ScalarType::kFloat64:
      return 8;
  }
  return 0;
}

bool isInteger(ScalarType type) {
  return type != ScalarType::kFloat32 && type != ScalarType::kFloat64;
}

CloudFields::CloudFields(const std::vector<CloudField>& fields, const InputFile& file) {
  index[kX] = find(fields, {"x"});
  index[kY] = find(fields, {"y"});
  index[kZ] = find(fields, {"z"});
  index[kIntensity] = find(fields, {"intensity", "reflectivity", "reflectance"});
  index[kRing] = find(fields, {"ring", "laser_id", "channel"});
  index[kTime] = find(fields, {"t", "time", "timestamp", "offset_time", "gps_time"});
  for (const auto& [role, name] : {std::pair{kX, "x"}, {kY, "y"}, {kZ, "z"}}) {
    if (!has(role)) file.fail(text("its points have no field '", name, "'"));
  }
  if (has(kTime)) {
    time_field = fields[index[kTime]].name;
    time_is_integer = isInteger(fields[index[kTime]].type);
  }
}

void readColumn(const Column& column, std::size_t count, double* out) {
  switch (column.type) {
    case ScalarType::kInt8:
      return readAs<std::int8_t>(column, count, out);
    case ScalarType::kUint8:
      return readAs<std::uint8_t>(column, count, out);
    case ScalarType::kInt16:
      return readAs<std::int16_t>(column, count, out);
    case ScalarType::kUint16:
      return readAs<std::uint16_t>(column, count, out);
    case ScalarType::kInt32:
      return readAs<std::int32_t>(column, count, out);
    case ScalarType::kUint32:
      return readAs<std::uint32_t>(column, count, out);
    case ScalarType::kInt64:
      return readAs<std::int64_t>(column, count, out);
    case ScalarType::kUint64:
      return readAs<std::uint64_t>(column, count, out);
    case ScalarType::kFloat32:
      return readAs<float>(column, count, out);
    case ScalarType::kFloat64:
      return readAs<double>(column, count, out);
  }
}

CloudBuilder::CloudBuilder(const InputFile& file, const CloudFields& fields, std::uint64_t rows,
                           const LoadOptions& options)
    : file_(file),
      fields_(fields),
      options_(options),
      budget_(options.memory_limit_bytes),
      rows_(rows) {
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (fields_.has(static_cast<Role>(role))) block_[role].resize(kBlockRows);
  }
  if (options.voxel_m > 0) {
    voxels_.emplace(options.voxel_m, budget_, file.name());
    return;
  }
  reserve();
  cloud_.time_field = fields_.time_field;
  cloud_.time_is_integer = fields_.time_is_integer;
}

void CloudBuilder::reserve() {
  std::uint64_t bytes = sizeof(Point3f);
  if (fields_.has(kIntensity)) bytes += sizeof(float);
  if (fields_.has(kRing)) bytes += sizeof(std::uint16_t);
  if (fields_.has(kTime)) bytes += sizeof(double);
  budget_.require(rows_ * bytes, text(file_.name(), ": a cloud of its ", rows_, " points"));
  cloud_.points.reserve(rows_);
  if (fields_.has(kIntensity)) cloud_.intensity.reserve(rows_);
  if (fields_.has(kRing)) cloud_.ring.reserve(rows_);
  if (fields_.has(kTime)) cloud_.time.reserve(rows_);
}

// The median of the first block, on a grid, so that a stray point at zero does not matter.
void CloudBuilder::chooseOrigin(std::size_t rows) {
  std::array<std::vector<double>, 3> finite;
  for (std::size_t i = 0; i < rows; ++i) {
    const std::array<double, 3> p{block_[kX][i], block_[kY][i], block_[kZ][i]};
    if (!std::all_of(p.begin(), p.end(), [](double v) { return std::isfinite(v); })) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) finite[axis].push_back(p[axis]);
  }
  if (finite[0].empty()) return;
  origin_chosen_ = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double middle = median(finite[axis]);
    const bool far = std::abs(middle) > kFarFromZero_m;
    const double origin = far ? std::round(middle / kOriginGrid_m) * kOriginGrid_m : 0.0;
    cloud_.origin[static_cast<Eigen::Index>(axis)] = origin;
  }
}

void CloudBuilder::addBlock(std::size_t rows) {
  if (!origin_chosen_) chooseOrigin(rows);
  const double *x = block_[kX].data(), *y = block_[kY].data(), *z = block_[kZ].data();
  for (std::size_t i = 0; i < rows; ++i) {
    const Point3f p{static_cast<float>(x[i] - cloud_.origin.x()),
                    static_cast<float>(y[i] - cloud_.origin.y()),
                    static_cast<float>(z[i] - cloud_.origin.z())};
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      ++cloud_.nonfinite_dropped;
      continue;
    }
    cloud_.points.push_back(p);
    if (fields_.has(kIntensity))
      cloud_.intensity.push_back(static_cast<float>(block_[kIntensity][i]));
    if (voxels_) continue;
    if (fields_.has(kRing)) cloud_.ring.push_back(asRing(block_[kRing][i]));
    if (fields_.has(kTime)) cloud_.time.push_back(block_[kTime][i]);
  }
  if (voxels_) thinBlock();
  tellProgress(rows);
}

void CloudBuilder::thinBlock() {
  voxels_->add(cloud_.points, cloud_.intensity);
  cloud_.points.clear();
  cloud_.intensity.clear();
}

void CloudBuilder::tellProgress(std::size_t rows) {
  constexpr std::uint64_t kEvery = 64 * kBlockRows;
  const bool due = rows_done_ / kEvery != (rows_done_ + rows) / kEvery;
  rows_done_ += rows;
  if (!due || !options_.progress) return;
  options_.progress(std::min(1.0, static_cast<double>(rows_done_) / static_cast<double>(rows_)));
}

PointCloud CloudBuilder::finish() {
  cloud_.points_read = static_cast<std::size_t>(rows_done_) - cloud_.nonfinite_dropped;
  if (voxels_) {
    voxels_->take(cloud_.points, fields_.has(kIntensity) ? &cloud_.intensity : nullptr);
  }
  if (cloud_.empty()) {
    if (cloud_.nonfinite_dropped == 0) file_.fail("has no points");
    file_.fail(text("none of its ", cloud_.nonfinite_dropped, " points is finite"));
  }
  return std::move(cloud_);
}

}  // namespace paloc
