#include "paloc/tools/rosbag_writer.h"

#include <console_bridge/console.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"

namespace paloc {
namespace {

// The messages' headers ask an allocator for `rebind`, which C++20's own has no more.
template <typename T>
struct RosAllocator : std::allocator<T> {
  using value_type = T;
  template <typename U>
  struct rebind {
    using other = RosAllocator<U>;
  };
  RosAllocator() = default;
  template <typename U>
  RosAllocator(const RosAllocator<U>& /*other*/) {}  // as the containers convert it
};
using Allocator = RosAllocator<void>;
using PointCloud2Message = sensor_msgs::PointCloud2_<Allocator>;
using PointFieldMessage = sensor_msgs::PointField_<Allocator>;
using ImuMessage = sensor_msgs::Imu_<Allocator>;
using OdometryMessage = nav_msgs::Odometry_<Allocator>;
using TransformsMessage = tf2_msgs::TFMessage_<Allocator>;

constexpr TimeNs kLargest = TimeNs{UINT32_MAX} * kNsPerSecond;

ros::Time rosTime(TimeNs t_ns) {
  return {static_cast<std::uint32_t>(t_ns / kNsPerSecond),
          static_cast<std::uint32_t>(t_ns % kNsPerSecond)};
}

// A bag's own stamp, of reception, must not be zero.
ros::Time receptionTime(TimeNs t_ns) { return rosTime(std::max<TimeNs>(t_ns, 1)); }

geometry_msgs::Quaternion_<Allocator> rosQuaternion(const Mat3& rotation) {
  const Eigen::Quaterniond q(rotation);
  geometry_msgs::Quaternion_<Allocator> result;
  result.x = q.x();
  result.y = q.y();
  result.z = q.z();
  result.w = q.w();
  return result;
}

template <typename V>
void setVector(V& to, const Vec3& from) {
  to.x = from.x();
  to.y = from.y();
  to.z = from.z();
}

// Offsets within a point, as Ouster's driver pads them.
constexpr std::uint32_t kX = 0, kIntensity = 16, kTime = 20, kRing = 26, kPointStep = 32;

void addField(PointCloud2Message& message, const char* name, std::uint32_t offset,
              std::uint8_t datatype) {
  PointFieldMessage field;
  field.name = name;
  field.offset = offset;
  field.datatype = datatype;
  field.count = 1;
  message.fields.push_back(field);
}

template <typename T>
void put(std::uint8_t* point, std::uint32_t offset, T value) {
  std::memcpy(point + offset, &value, sizeof(T));
}

PointCloud2Message pointCloud2(const LidarFrame& scan, RosCloudLayout layout) {
  using Field = PointFieldMessage;
  const bool ouster = layout == RosCloudLayout::kOuster;
  PointCloud2Message message;
  message.header.stamp = rosTime(scan.deskewed ? scan.endNs() : scan.stamp_ns);
  addField(message, "x", kX, Field::FLOAT32);
  addField(message, "y", kX + 4, Field::FLOAT32);
  addField(message, "z", kX + 8, Field::FLOAT32);
  if (!scan.intensity.empty()) addField(message, "intensity", kIntensity, Field::FLOAT32);
  if (!scan.dt_ns.empty()) {
    addField(message, ouster ? "t" : "time", kTime, ouster ? Field::UINT32 : Field::FLOAT32);
  }
  if (!scan.ring.empty()) addField(message, "ring", kRing, Field::UINT16);
  message.height = 1;
  message.width = static_cast<std::uint32_t>(scan.points_lidar.size());
  message.point_step = kPointStep;
  message.row_step = message.width * kPointStep;
  message.is_dense = 1;
  message.data.resize(message.row_step);
  for (std::size_t i = 0; i < scan.points_lidar.size(); ++i) {
    std::uint8_t* point = message.data.data() + i * kPointStep;
    put(point, kX, scan.points_lidar[i].x);
    put(point, kX + 4, scan.points_lidar[i].y);
    put(point, kX + 8, scan.points_lidar[i].z);
    if (!scan.intensity.empty()) put(point, kIntensity, scan.intensity[i]);
    if (!scan.ring.empty()) put(point, kRing, scan.ring[i]);
    if (scan.dt_ns.empty()) continue;
    if (ouster) {
      put(point, kTime, scan.dt_ns[i]);
    } else {
      put(point, kTime, static_cast<float>(static_cast<double>(scan.dt_ns[i]) * 1e-9));
    }
  }
  return message;
}

}  // namespace

struct RosbagWriter::Impl {
  std::filesystem::path file;
  std::unique_ptr<rosbag::Bag> bag;

  // A bag that could not be written would throw again in its destructor, which ends the program:
  // it is let go of, and closed by the system.
  template <typename Work>
  void guarded(Work&& work) {
    try {
      work();
    } catch (const std::exception& e) {
      static_cast<void>(bag.release());
      throw IoError(text(file.string(), ": cannot be written (", e.what(), ")"));
    }
  }

  template <typename Message>
  void write(const std::string& topic, TimeNs t_ns, const Message& message,
             const boost::shared_ptr<ros::M_string>& connection = {}) {
    if (!bag) throw IoError(text(file.string(), ": cannot be written any more"));
    guarded([&] { bag->write(topic, receptionTime(t_ns), message, connection); });
  }
};

RosbagWriter::RosbagWriter(const std::filesystem::path& file) : impl_(std::make_unique<Impl>()) {
  console_bridge::noOutputHandler();
  impl_->file = file;
  impl_->guarded([&] {
    impl_->bag = std::make_unique<rosbag::Bag>();
    impl_->bag->open(file.string(), rosbag::bagmode::Write);
  });
}

RosbagWriter::~RosbagWriter() {
  try {
    close();
  } catch (const IoError&) {  // whoever wants to know closes it
  }
}

bool RosbagWriter::canHold(TimeNs t_ns) { return t_ns >= 0 && t_ns < kLargest; }

void RosbagWriter::writeScan(const std::string& topic, const std::string& frame,
                             const LidarFrame& scan, RosCloudLayout layout) {
  PointCloud2Message message = pointCloud2(scan, layout);
  message.header.frame_id = frame.c_str();
  impl_->write(topic, scan.endNs(), message);  // a driver gives it out when it is complete
}

void RosbagWriter::writeImu(const std::string& topic, const std::string& frame,
                            const ImuSample& sample) {
  ImuMessage message;
  message.header.stamp = rosTime(sample.t_ns);
  message.header.frame_id = frame.c_str();
  message.orientation.w = 1;
  message.orientation_covariance[0] = -1;  // ROS's sign for: there is no orientation
  setVector(message.angular_velocity, sample.omega_body);
  setVector(message.linear_acceleration, sample.acc_body);
  impl_->write(topic, sample.t_ns, message);
}

void RosbagWriter::writeOdometry(const std::string& topic, const std::string& frame,
                                 const std::string& child_frame, const OdometryPose& pose) {
  OdometryMessage message;
  message.header.stamp = rosTime(pose.t_ns);
  message.header.frame_id = frame.c_str();
  message.child_frame_id = child_frame.c_str();
  setVector(message.pose.pose.position, pose.T_odom_body.position);
  message.pose.pose.orientation = rosQuaternion(pose.T_odom_body.rotation);
  if (pose.step_covariance) {
    Mat6 j = Mat6::Identity();  // rotation on the right -> about the frame's own axes
    j.bottomRightCorner<3, 3>() = pose.T_odom_body.rotation;
    const Mat6 covariance = j * *pose.step_covariance * j.transpose();
    for (int i = 0; i < 36; ++i) {
      message.pose.covariance[static_cast<std::size_t>(i)] = covariance(i / 6, i % 6);
    }
  }
  impl_->write(topic, pose.t_ns, message);
}

void RosbagWriter::writeStaticTransform(TimeNs t_ns, const std::string& frame,
                                        const std::string& child_frame, const Pose& T_frame_child) {
  TransformsMessage message;
  message.transforms.resize(1);
  auto& transform = message.transforms.front();
  transform.header.stamp = rosTime(t_ns);
  transform.header.frame_id = frame.c_str();
  transform.child_frame_id = child_frame.c_str();
  setVector(transform.transform.translation, T_frame_child.position);
  transform.transform.rotation = rosQuaternion(T_frame_child.rotation);
  using Traits = TransformsMessage;
  const auto connection = boost::make_shared<ros::M_string>();
  (*connection)["type"] = ros::message_traits::DataType<Traits>::value();
  (*connection)["md5sum"] = ros::message_traits::MD5Sum<Traits>::value();
  (*connection)["message_definition"] = ros::message_traits::Definition<Traits>::value();
  (*connection)["latching"] = "1";
  (*connection)["callerid"] = "/paloc_" + child_frame;
  impl_->write("/tf_static", t_ns, message, connection);
}

void RosbagWriter::close() {
  if (!impl_->bag) return;
  impl_->guarded([&] { impl_->bag->close(); });
  impl_->bag.reset();
}

}  // namespace paloc
