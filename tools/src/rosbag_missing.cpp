// Takes the place of rosbag_reader.cpp and rosbag_writer.cpp where librosbag-storage is not there.
#include "paloc/core/errors.h"
#include "paloc/tools/rosbag_reader.h"
#include "paloc/tools/rosbag_writer.h"

namespace paloc {
namespace {

[[noreturn]] void failMissing() {
  throw UsageError(
      "this paloc was built without ROS bags: install librosbag-storage-dev, libsensor-msgs-dev, "
      "libnav-msgs-dev and libtf2-msgs-dev, and build it anew");
}

}  // namespace

struct RosbagReader::Impl {};
struct RosbagWriter::Impl {};

bool builtWithRosbag() { return false; }

RosbagReader::RosbagReader(const std::vector<std::filesystem::path>&) { failMissing(); }
RosbagReader::~RosbagReader() = default;
const std::vector<RosbagTopic>& RosbagReader::topics() const { failMissing(); }
void RosbagReader::read(const std::vector<std::string>&,
                        const std::function<void(const RosbagMessage&, double)>&,
                        const std::function<void(const std::string&)>&) {
  failMissing();
}
RosBytes RosbagReader::again(std::size_t) { failMissing(); }

RosbagWriter::RosbagWriter(const std::filesystem::path&) { failMissing(); }
RosbagWriter::~RosbagWriter() = default;
bool RosbagWriter::canHold(TimeNs) { failMissing(); }
void RosbagWriter::writeScan(const std::string&, const std::string&, const LidarFrame&,
                             RosCloudLayout) {
  failMissing();
}
void RosbagWriter::writeImu(const std::string&, const std::string&, const ImuSample&) {
  failMissing();
}
void RosbagWriter::writeOdometry(const std::string&, const std::string&, const std::string&,
                                 const OdometryPose&) {
  failMissing();
}
void RosbagWriter::writeStaticTransform(TimeNs, const std::string&, const std::string&,
                                        const Pose&) {
  failMissing();
}
void RosbagWriter::close() { failMissing(); }

}  // namespace paloc
