#include "paloc/tools/ros_messages.h"

#include <Eigen/Geometry>
#include <bit>
#include <cstring>

namespace paloc {
namespace {

static_assert(std::endian::native == std::endian::little, "ROS serializes in little endian");

// Reads one value after the other. Once a read would go beyond the end, it and all that follow give
// zeros, and whole() is false.
class Reader {
 public:
  explicit Reader(RosBytes bytes) : rest_(bytes) {}

  template <typename T>
  T read() {
    T value{};
    const RosBytes bytes = block(sizeof(T));
    if (good_) std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }
  RosBytes block(std::size_t size) {
    good_ = good_ && size <= rest_.size();
    if (!good_) return {};
    const RosBytes bytes = rest_.first(size);
    rest_ = rest_.subspan(size);
    return bytes;
  }
  std::string string() {
    const RosBytes bytes = block(read<std::uint32_t>());
    return {bytes.begin(), bytes.end()};
  }
  std::string frame() {
    std::string name = string();
    return name.starts_with('/') ? name.substr(1) : name;
  }
  RosHeader header() {
    RosHeader header;
    read<std::uint32_t>();  // seq
    const auto s = read<std::uint32_t>();
    header.stamp_ns = TimeNs{s} * kNsPerSecond + read<std::uint32_t>();
    header.frame = frame();
    return header;
  }
  Vec3 vector() {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = read<double>();
    return v;
  }
  // Not a number where the quaternion is not one of a rotation.
  Pose pose() {
    Pose pose;
    pose.position = vector();
    const Vec3 xyz = vector();
    const Eigen::Quaterniond q(read<double>(), xyz.x(), xyz.y(), xyz.z());
    constexpr double kFromUnit = 0.01;
    const bool unit = std::abs(q.norm() - 1) < kFromUnit;
    pose.rotation = unit ? Mat3(q.normalized().toRotationMatrix()) : Mat3(Mat3::Constant(NAN));
    return pose;
  }
  bool good() const { return good_; }
  bool whole() const { return good_ && rest_.empty(); }

 private:
  RosBytes rest_;
  bool good_ = true;
};

template <typename T>
std::optional<T> ifWhole(const Reader& in, T message) {
  if (!in.whole()) return std::nullopt;
  return message;
}

}  // namespace

std::optional<RosPointCloud2> parsePointCloud2(RosBytes message) {
  Reader in(message);
  RosPointCloud2 cloud;
  cloud.header = in.header();
  cloud.height = in.read<std::uint32_t>();
  cloud.width = in.read<std::uint32_t>();
  const auto fields = in.read<std::uint32_t>();
  for (std::uint32_t i = 0; i < fields && in.good(); ++i) {
    RosPointField field;
    field.name = in.string();
    field.offset = in.read<std::uint32_t>();
    field.datatype = in.read<std::uint8_t>();
    in.read<std::uint32_t>();  // count: of an array, the first is read
    cloud.fields.push_back(std::move(field));
  }
  cloud.big_endian = in.read<std::uint8_t>() != 0;
  cloud.point_step = in.read<std::uint32_t>();
  cloud.row_step = in.read<std::uint32_t>();
  cloud.data = in.block(in.read<std::uint32_t>());
  in.read<std::uint8_t>();  // is_dense
  return ifWhole(in, std::move(cloud));
}

std::optional<LivoxCustomMsg> parseLivoxCustom(RosBytes message) {
  Reader in(message);
  LivoxCustomMsg cloud;
  cloud.header = in.header();
  cloud.timebase_ns = in.read<std::uint64_t>();
  in.block(8);  // point_num, lidar_id, rsvd[3]
  const std::size_t points = in.read<std::uint32_t>();
  cloud.points = in.block(points * LivoxCustomMsg::kPointBytes);
  return ifWhole(in, std::move(cloud));
}

std::optional<RosImu> parseImu(RosBytes message) {
  Reader in(message);
  RosImu imu;
  imu.header = in.header();
  in.block(13 * sizeof(double));  // orientation and its covariance
  imu.omega = in.vector();
  in.block(9 * sizeof(double));
  imu.acc = in.vector();
  in.block(9 * sizeof(double));
  return ifWhole(in, std::move(imu));
}

std::optional<RosOdometry> parseOdometry(RosBytes message) {
  Reader in(message);
  RosOdometry odometry;
  odometry.header = in.header();
  odometry.child_frame = in.frame();
  odometry.T_frame_child = in.pose();
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col) odometry.covariance(row, col) = in.read<double>();
  }
  in.block(42 * sizeof(double));  // twist and its covariance
  return ifWhole(in, std::move(odometry));
}

std::optional<std::vector<RosTransform>> parseTransforms(RosBytes message) {
  Reader in(message);
  const auto count = in.read<std::uint32_t>();
  std::vector<RosTransform> transforms;
  for (std::uint32_t i = 0; i < count && in.good(); ++i) {
    RosTransform t;
    t.frame = in.header().frame;
    t.child_frame = in.frame();
    t.T_frame_child = in.pose();
    transforms.push_back(std::move(t));
  }
  return ifWhole(in, std::move(transforms));
}

}  // namespace paloc
