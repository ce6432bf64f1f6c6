#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/core/time.h"

/// The messages of ROS 1 that paloc reads, from their serialized form. Nothing is read beyond the
/// message and nothing is allocated for a length that the message does not have, which ROS's own
/// reading does. No part of ROS is needed.
namespace paloc {

using RosBytes = std::span<const std::uint8_t>;

/// A type of message: its name, and the MD5 sum of its definition.
struct RosType {
  std::string_view name, md5;
};
inline constexpr RosType kRosPointCloud2{"sensor_msgs/PointCloud2",
                                         "1158d486dd51d683ce2f1be655c3c181"};
inline constexpr RosType kRosImu{"sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2"};
inline constexpr RosType kRosOdometry{"nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7"};
inline constexpr RosType kRosTransforms{"tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec"};
inline constexpr RosType kLivoxCustom{"livox_ros_driver/CustomMsg",
                                      "e4d6829bdfe657cb6c21a746c86b21a6"};
inline constexpr RosType kLivoxCustom2{"livox_ros_driver2/CustomMsg",
                                       "e4d6829bdfe657cb6c21a746c86b21a6"};

struct RosHeader {
  TimeNs stamp_ns = 0;
  std::string frame;  ///< frame_id without a leading '/'
};

struct RosPointField {
  std::string name;
  std::uint32_t offset = 0;   ///< bytes, within a point
  std::uint8_t datatype = 0;  ///< 1 int8, uint8, int16, uint16, int32, uint32, float32, 8 float64
};

struct RosPointCloud2 {
  RosHeader header;
  std::uint32_t height = 0, width = 0;
  std::vector<RosPointField> fields;
  bool big_endian = false;
  std::uint32_t point_step = 0, row_step = 0;  ///< bytes
  RosBytes data;                               ///< a view into the message
};

/// The points of a CustomMsg, 19 bytes each: uint32 offset_time (ns after timebase), float32 x, y,
/// z (m), uint8 reflectivity, tag, line.
struct LivoxCustomMsg {
  RosHeader header;
  std::uint64_t timebase_ns = 0;
  RosBytes points;  ///< a view into the message
  static constexpr std::size_t kPointBytes = 19;
};

struct RosImu {
  RosHeader header;
  Vec3 acc = Vec3::Zero();    ///< m/s2, in the frame of the header
  Vec3 omega = Vec3::Zero();  ///< rad/s
};

struct RosOdometry {
  RosHeader header;
  std::string child_frame;
  Pose T_frame_child;
  /// [x y z (m), rotation about x y z (rad)], all along the axes of the header's frame.
  Mat6 covariance = Mat6::Zero();
};

struct RosTransform {
  std::string frame, child_frame;
  Pose T_frame_child;
};

/// Each: nothing if the message is shorter than it says it is, or ends after what it holds.
std::optional<RosPointCloud2> parsePointCloud2(RosBytes message);
std::optional<LivoxCustomMsg> parseLivoxCustom(RosBytes message);
std::optional<RosImu> parseImu(RosBytes message);
std::optional<RosOdometry> parseOdometry(RosBytes message);
std::optional<std::vector<RosTransform>> parseTransforms(RosBytes message);

}  // namespace paloc
