#include "paloc/tools/import_rosbag.h"

#include <algorithm>
#include <cmath>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/text.h"
#include "paloc/tools/result_folder.h"
#include "paloc/tools/ros_cloud.h"
#include "paloc/tools/static_transforms.h"

namespace paloc {
namespace {

constexpr double kStandardGravity_mps2 = 9.80665;
constexpr const char* kStaticTopic = "/tf_static";

std::string listOf(const std::vector<RosbagTopic>& topics) {
  std::string list;
  for (const auto& t : topics) {
    list += text(list.empty() ? "" : ", ", t.name, " (", t.type, ", ", t.messages, ")");
  }
  return list.empty() ? "none" : list;
}

// The topic asked for, or the only one of these types; empty if there is none, or none is wanted.
std::string chooseTopic(const std::vector<RosbagTopic>& topics, const std::string& asked,
                        const std::string& option, std::initializer_list<RosType> types) {
  if (asked == "none") return {};
  std::vector<RosbagTopic> candidates;
  bool there = false;
  for (const auto& topic : topics) {
    there = there || topic.name == asked;
    for (const RosType& type : types) {
      if (topic.type != type.name || (!asked.empty() && topic.name != asked)) continue;
      if (topic.md5 != type.md5) {
        throw IoError(text(topic.name, ": is a ", topic.type, " of another definition (MD5 ",
                           topic.md5, ", known is ", type.md5, ")"));
      }
      candidates.push_back(topic);
    }
  }
  if (candidates.size() == 1) return candidates.front().name;
  if (!asked.empty()) {
    throw UsageError(text(option, ": ", asked, there ? " is of another type" : " is not there",
                          "; the topics are ", listOf(topics)));
  }
  if (candidates.empty()) return {};
  throw UsageError(text("which topic is meant? Say ", option, "; there are ", listOf(candidates)));
}

// What the first reading of the bags finds.
class BagContents {
 public:
  BagContents(const ImportRosbagSettings& settings, RosbagReader& reader, ImportSummary& summary)
      : settings_(settings), reader_(reader), summary_(summary) {
    const auto& topics = reader.topics();
    lidar_ = chooseTopic(topics, settings.lidar, "--lidar",
                         {kRosPointCloud2, kLivoxCustom, kLivoxCustom2});
    imu_ = chooseTopic(topics, settings.imu, "--imu", {kRosImu});
    odometry_ = chooseTopic(topics, settings.odometry, "--odometry", {kRosOdometry});
    if (lidar_.empty()) {
      throw IoError(text("there is no topic of a LiDAR; the topics are ", listOf(topics)));
    }
    summary_.notes.push_back(text("LiDAR ", lidar_, ", IMU ", imu_.empty() ? "none" : imu_,
                                  ", odometry ", odometry_.empty() ? "none" : odometry_));
  }

  void read(const std::function<void(double)>& progress) {
    std::vector<std::string> wanted;
    for (const auto& topic : {lidar_, imu_, odometry_}) {
      if (!topic.empty()) wanted.push_back(topic);
    }
    constexpr double kFirstHalf = 0.5;
    const auto damaged = [this](const std::string& why) {
      if (++summary_.not_used["messages that cannot be read"] == 1) {
        summary_.notes.push_back(text("not read: ", why));
      }
    };
    const auto transform = [this](const RosbagMessage& m, double) { addTransforms(m); };
    reader_.read({kStaticTopic}, transform, damaged);
    const auto take = [&](const RosbagMessage& m, double share) {
      if (m.topic == lidar_) addScan(m);
      if (m.topic == imu_) addImu(m);
      if (m.topic == odometry_) addOdometry(m);
      progress(kFirstHalf * share);
    };
    reader_.read(wanted, take, damaged);
    if (scans_.empty())
      throw IoError(text(lidar_, ": has no scan that can be read", first_refusal_));
    if (!parts_.imu.empty()) noteImuUnit(parts_.imu, summary_);
  }

  ImportParts& parts() { return parts_; }

  std::optional<RosCloud> cloudOf(const std::string& type, RosBytes bytes,
                                  std::string& refusal) const {
    return type == kRosPointCloud2.name ? readPointCloud2(bytes, settings_.time_field, refusal)
                                        : readLivoxCustom(bytes, refusal);
  }
  const std::string& lidarType() const { return lidar_type_; }

  // How times and intensities are to be read.
  void decideReading(ScanConversion& how) {
    if (max_intensity_ > 0 && max_intensity_ <= 1 && !whole_intensities_) {
      how.intensity_scale = 255;
      summary_.notes.emplace_back("intensities lie between 0 and 1: multiplied by 255");
    }
    const bool spread =
        std::any_of(samples_.begin(), samples_.end(), [](const auto& s) { return s.max > s.min; });
    if (spread) {
      rule_ = decidePointTimes(samples_, scanPeriod(stamps()), settings_.time_unit,
                               settings_.time_reference);
      summary_.notes.push_back(rule_->sentence);
      how.times = PointTimeRule{TimeUnit::kNanoseconds, TimeReference::kStamp, rule_->sentence};
    } else {
      summary_.notes.push_back(text(
          samples_.empty() ? "points have no times"
                           : "the times of points are all the same, and not used",
          how.deskewed == Deskewed::kNo    ? ": the scans are not deskewed, as stated"
          : how.deskewed == Deskewed::kYes ? ": the scans are deskewed, as stated"
                                           : ": the scans are taken as deskewed to their stamp "
                                             "(--not-deskewed if they are not)"));
    }
    if (timebase_differs_) {
      summary_.notes.emplace_back(
          "Livox's timebase is on another clock than the headers: times count from the stamp");
    }
    if (how.deskewed == Deskewed::kGuess && rule_) how.deskewed = Deskewed::kNo;
  }

  // The stamp of a scan becomes that of its first point; the scans are put in order.
  void orderScans() {
    for (FoundScan& scan : scans_) {
      TimeNs first = scan.header_ns;
      if (rule_ && scan.has_times) {
        const TimeNs t = timesOf({scan.min_time}, scan.header_ns).front();
        const bool moves = t < first || rule_->reference == TimeReference::kAbsolute;
        if (t != kNoTime && moves) first = t;
      }
      parts_.scans.push_back({{}, first, {}, {}, scan.place});
    }
    const auto earlier = [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; };
    std::uint64_t backwards = 0;
    for (std::size_t i = 1; i < parts_.scans.size(); ++i) {
      backwards += earlier(parts_.scans[i], parts_.scans[i - 1]) ? 1 : 0;
    }
    std::stable_sort(parts_.scans.begin(), parts_.scans.end(), earlier);
    const auto end = std::unique(parts_.scans.begin(), parts_.scans.end(),
                                 [](auto& a, auto& b) { return a.stamp_ns == b.stamp_ns; });
    const auto repeated = static_cast<std::uint64_t>(parts_.scans.end() - end);
    parts_.scans.erase(end, parts_.scans.end());
    if (backwards > 0) summary_.noticed["scans that go back in time (put in order)"] = backwards;
    if (repeated > 0) summary_.not_used["scans with the stamp of another"] = repeated;
  }

  void placeSensors(ScanConversion& how) {
    const std::string body = !imu_frame_.empty()     ? imu_frame_
                             : !child_frame_.empty() ? child_frame_
                                                     : lidar_frame_;
    if (settings_.has_T_body_lidar) {
      summary_.notes.emplace_back("the LiDAR's place in the body is as stated");
    } else {
      how.T_body_lidar = toMrpt(placeOf("LiDAR", body, lidar_frame_));
    }
    if (!parts_.odometry.empty()) {
      parts_.T_body_odometry = placeOf("odometry", body, child_frame_);
    }
  }

  // Loads a scan once more; its times become nanoseconds after the entry's stamp.
  PointCloud load(const ScanEntry& entry) {
    std::string refusal;
    auto read = cloudOf(lidar_type_, reader_.again(entry.place), refusal);
    if (!read) throw IoError(text(lidar_, ": a scan is ", refusal));
    if (read->zero_dropped > 0) {
      summary_.noticed["points at the sensor itself (left out)"] += read->zero_dropped;
    }
    PointCloud cloud = std::move(read->cloud);
    if (!rule_) cloud.time.clear();
    if (cloud.time.empty()) return cloud;
    const std::vector<TimeNs> times = timesOf(cloud.time, read->stamp_ns);
    for (std::size_t i = 0; i < times.size(); ++i) {
      cloud.time[i] = times[i] == kNoTime ? NAN : static_cast<double>(times[i] - entry.stamp_ns);
    }
    return cloud;
  }

 private:
  struct FoundScan {
    std::size_t place;
    TimeNs header_ns;
    bool has_times;
    double min_time;
  };

  // Negative times of ROS drivers count back from the header's stamp.
  std::vector<TimeNs> timesOf(const std::vector<double>& values, TimeNs header_ns) const {
    return readPointTimes(*rule_, values, header_ns, header_ns);
  }

  std::vector<TimeNs> stamps() const {
    std::vector<TimeNs> result;
    for (const FoundScan& scan : scans_) result.push_back(scan.header_ns);
    return result;
  }

  Pose placeOf(const std::string& what, const std::string& body, const std::string& frame) {
    const auto found = transforms_.find(body, frame);
    if (found && body != frame) {
      summary_.notes.push_back(text("the ", what, "'s place in the body is ", kStaticTopic,
                                    "'s, from '", body, "' to '", frame, "'"));
      return *found;
    }
    summary_.notes.push_back(found
                                 ? text("the ", what, " is in the body's own frame '", body, "'")
                                 : text("the ", what, " is taken to be at the body: ", kStaticTopic,
                                        " does not lead from '", body, "' to '", frame, "'"));
    return {};
  }

  void addTransforms(const RosbagMessage& message) {
    auto transforms = parseTransforms(message.bytes);
    if (message.md5 != kRosTransforms.md5 || !transforms) {
      ++summary_.not_used["static transforms that cannot be read"];
      return;
    }
    for (auto& t : *transforms) transforms_.add(std::move(t));
  }

  void addScan(const RosbagMessage& message) {
    std::string refusal;
    const auto read = cloudOf(message.type, message.bytes, refusal);
    if (read && read->cloud.empty()) refusal = "without a point";
    if (!refusal.empty()) {
      ++summary_.not_used["scans " + refusal];
      if (first_refusal_.empty()) first_refusal_ = text("; they are ", refusal);
      return;
    }
    const PointCloud& cloud = read->cloud;
    lidar_type_ = message.type;
    lidar_frame_ = read->frame;
    timebase_differs_ = timebase_differs_ || read->timebase_differs;
    double low = INFINITY, high = -INFINITY;
    for (const double t : cloud.time) {
      if (!std::isfinite(t)) continue;
      low = std::min(low, t);
      high = std::max(high, t);
    }
    const bool has_times = low <= high;
    scans_.push_back({message.place, read->stamp_ns, has_times, low});
    if (has_times) {
      samples_.push_back({read->stamp_ns, low, high, cloud.time_field, cloud.time_is_integer});
    }
    for (const float v : cloud.intensity) {
      if (std::isfinite(v)) max_intensity_ = std::max(max_intensity_, v);
      whole_intensities_ = whole_intensities_ && v == std::floor(v);
    }
  }

  void addImu(const RosbagMessage& message) {
    const auto imu = parseImu(message.bytes);
    if (!imu || !imu->acc.allFinite() || !imu->omega.allFinite()) {
      ++summary_.not_used[imu ? "IMU samples that are not finite" : "IMU messages cut short"];
      return;
    }
    imu_frame_ = imu->header.frame;
    const double unit = settings_.imu_in_g ? kStandardGravity_mps2 : 1;
    parts_.imu.push_back({imu->header.stamp_ns, unit * imu->acc, imu->omega});
  }

  void addOdometry(const RosbagMessage& message) {
    const auto odometry = parseOdometry(message.bytes);
    const bool finite = odometry && odometry->T_frame_child.position.allFinite() &&
                        odometry->T_frame_child.rotation.allFinite();
    if (!finite) {
      ++summary_.not_used[odometry ? "odometry poses that are not finite"
                                   : "odometry messages cut short"];
      return;
    }
    child_frame_ = odometry->child_frame;
    const TimeNs t_ns = odometry->header.stamp_ns;
    parts_.odometry.push_back({t_ns, odometry->T_frame_child});
    const Mat6& c = odometry->covariance;
    if (settings_.no_covariance || c.isZero(0)) return;
    if (!c.allFinite() || !(c.diagonal().minCoeff() >= 0)) {
      ++summary_.noticed["odometry covariances that are none (left out)"];
      return;
    }
    if (parts_.odometry_covariances.empty()) {
      summary_.notes.emplace_back(
          "the odometry's covariances are taken as those of the motion since the pose before "
          "(--no-covariance leaves them out)");
    }
    Mat6 j = Mat6::Identity();  // rotation about the frame's axes -> on the right
    j.bottomRightCorner<3, 3>() = odometry->T_frame_child.rotation.transpose();
    parts_.odometry_covariances.emplace(t_ns, j * c * j.transpose());
  }

  const ImportRosbagSettings& settings_;
  RosbagReader& reader_;
  ImportSummary& summary_;
  std::string lidar_, imu_, odometry_;  // topics
  std::string lidar_type_, lidar_frame_, imu_frame_, child_frame_, first_refusal_;
  ImportParts parts_;
  StaticTransforms transforms_;
  std::vector<FoundScan> scans_;
  std::vector<PointTimeSample> samples_;
  std::optional<PointTimeRule> rule_;
  float max_intensity_ = 0;
  bool whole_intensities_ = true, timebase_differs_ = false;
};

}  // namespace

ImportSummary importRosbag(const ImportRosbagSettings& settings,
                           const std::function<void(double)>& progress) {
  checkNotThere(settings.output.file, settings.output.overwrite);
  RosbagReader reader(settings.bags);
  ImportSummary summary;
  BagContents bags(settings, reader, summary);
  bags.read(progress);
  ScanConversion how = settings.scans;
  bags.decideReading(how);
  bags.orderScans();
  bags.placeSensors(how);
  ImportParts parts = std::move(bags.parts());
  parts.load = [&bags](const ScanEntry& entry) { return bags.load(entry); };
  writeRecording(
      std::move(parts), how, settings.output, [&](double share) { progress(0.5 + 0.5 * share); },
      summary);
  return summary;
}

}  // namespace paloc
