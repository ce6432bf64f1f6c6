#include "paloc/tools/export_rosbag.h"

#include <mrpt/obs/CObservationIMU.h>

#include <nlohmann/json.hpp>
#include <set>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/frontends/imu_reader.h"
#include "paloc/frontends/lidar_decoder.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/tools/result_folder.h"

namespace paloc {
namespace {

constexpr const char* kBody = "body";

// A label as a ROS name: letters, digits and underscores, a letter first.
std::string rosName(const std::string& label, const char* otherwise) {
  std::string name;
  for (const char c : label) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool digit = c >= '0' && c <= '9';
    if (name.empty() && !letter) continue;
    name += letter || digit ? c : '_';
  }
  return name.empty() || name == kBody ? otherwise : name;
}

class Exporter {
 public:
  Exporter(const ExportRosbagSettings& settings, RosbagWriter& bag, ExportSummary& summary)
      : layout_(settings.layout), bag_(bag), summary_(summary) {}

  void add(const mrpt::obs::CObservation& observation) {
    std::string refusal;
    bool written = false;
    if (isLidar(observation)) {
      written = addScan(observation, refusal);
    } else if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation)) {
      written = addImu(*imu, refusal);
    } else if (isOdometry(observation)) {
      written = addOdometry(observation, refusal);
    } else {
      refusal = "of a class that is not exported";
    }
    if (!written) {
      const std::string name = observation.GetRuntimeClass()->className;
      ++summary_.not_used[text(name, " '", observation.sensorLabel, "': ", refusal)];
    }
  }

 private:
  bool holds(TimeNs t_ns, std::string& refusal) const {
    if (RosbagWriter::canHold(t_ns)) return true;
    refusal = "its stamp is none that ROS can hold (1970 to 2106)";
    return false;
  }

  bool addScan(const mrpt::obs::CObservation& observation, std::string& refusal) {
    const auto scan = decodeLidar(observation, {true, true}, refusal);
    if (!scan || !holds(scan->stamp_ns, refusal) || !holds(scan->endNs(), refusal)) return false;
    const std::string frame = rosName(scan->label, "lidar");
    if (placed_.insert(frame).second) {
      bag_.writeStaticTransform(scan->stamp_ns, kBody, frame, scan->T_body_lidar);
      summary_.topics["/tf_static"] = "tf2_msgs/TFMessage";
    }
    bag_.writeScan("/" + frame, frame, *scan, layout_);
    summary_.topics["/" + frame] = "sensor_msgs/PointCloud2";
    ++summary_.scans;
    return true;
  }

  bool addImu(const mrpt::obs::CObservationIMU& observation, std::string& refusal) {
    const auto sample = decodeImu(observation, refusal);
    if (!sample || !holds(sample->t_ns, refusal)) return false;
    const std::string topic = "/" + rosName(observation.sensorLabel, "imu");
    bag_.writeImu(topic, kBody, *sample);
    summary_.topics[topic] = "sensor_msgs/Imu";
    ++summary_.imu_samples;
    return true;
  }

  bool addOdometry(const mrpt::obs::CObservation& observation, std::string& refusal) {
    const auto pose = decodeOdometry(observation, refusal);
    if (!pose || !holds(pose->t_ns, refusal)) return false;
    const std::string topic = "/" + rosName(observation.sensorLabel, "odometry");
    bag_.writeOdometry(topic, "odom", kBody, *pose);
    summary_.topics[topic] = "nav_msgs/Odometry";
    ++summary_.odometry_poses;
    return true;
  }

  RosCloudLayout layout_;
  RosbagWriter& bag_;
  ExportSummary& summary_;
  std::set<std::string> placed_;
};

}  // namespace

ExportSummary exportRosbag(const ExportRosbagSettings& settings,
                           const std::function<void(double)>& progress) {
  checkNotThere(settings.bag, settings.overwrite);
  RawlogStream log(settings.log);
  RosbagWriter bag(settings.bag);
  ExportSummary summary;
  Exporter exporter(settings, bag, summary);
  while (const auto observation = log.next()) {
    exporter.add(*observation);
    progress(log.progress());
  }
  bag.close();
  if (log.end() == RawlogStream::End::kDamaged) summary.damage = log.error();
  if (summary.topics.empty()) {
    throw IoError(text(settings.log.string(), ": holds nothing that can be exported",
                       summary.damage.empty() ? "" : "; ", summary.damage));
  }
  summary.output = settings.bag.string();
  std::error_code ignored;
  summary.bytes = std::filesystem::file_size(settings.bag, ignored);
  return summary;
}

std::string tableOf(const ExportSummary& s) {
  std::string table =
      text(s.output, "\n  bytes           ", s.bytes, "\n  scans           ", s.scans,
           "\n  IMU samples     ", s.imu_samples, "\n  odometry poses  ", s.odometry_poses, '\n');
  for (const auto& [topic, type] : s.topics) table += text("  topic ", topic, "  ", type, '\n');
  for (const auto& [reason, count] : s.not_used) {
    table += text("  NOT USED ", count, " ", reason, '\n');
  }
  if (!s.damage.empty()) table += text("  DAMAGED ", s.damage, '\n');
  return table;
}

nlohmann::json jsonOf(const ExportSummary& s) {
  return {{"output", s.output},
          {"bytes", s.bytes},
          {"scans", s.scans},
          {"imu_samples", s.imu_samples},
          {"odometry_poses", s.odometry_poses},
          {"topics", s.topics},
          {"not_used", s.not_used},
          {"damage", s.damage}};
}

}  // namespace paloc
