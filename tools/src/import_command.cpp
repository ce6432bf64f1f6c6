#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/import_clouds.h"
#include "paloc/tools/import_kitti.h"
#include "paloc/tools/import_rosbag.h"
#include "paloc/tools/parse_pose.h"
#include "paloc/tools/print_result.h"
#include "paloc/tools/progress_line.h"

namespace paloc {
namespace {

constexpr const char* kCloudsExample = R"(Example:
  paloc import clouds scans --times times.txt --odometry odometry.tum --imu imu.csv -o log.rawlog

Clouds: PCD (ascii, binary, binary_compressed), PLY, KITTI's .bin. A field t, time or timestamp gives
each point its time, a field ring its laser.
--times:    lines of `name stamp_of_the_first_point_s [of_the_last_s]`
--odometry: TUM, the body's pose, at any stamps
--imu:      CSV with the columns t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps
Exit codes: 0 all imported, 1 part of it could not be used, 2 wrong usage, 3 wrong input.)";

constexpr const char* kKittiExample = R"(Example:
  paloc import kitti 2011_09_26/2011_09_26_drive_0001_sync -o log.rawlog

Reads velodyne_points, oxts (IMU, and pose as odometry; the body is the oxts unit) and
calib_imu_to_velo.txt, in the drive's folder or the one above.
Exit codes: 0 all imported, 1 part of it could not be used, 2 wrong usage, 3 wrong input.)";

constexpr const char* kRosbagExample = R"(Example:
  paloc import rosbag walk.bag --list
  paloc import rosbag walk_0.bag walk_1.bag --lidar /os_cloud_node/points --imu /imu/data -o log.rawlog

LiDAR: sensor_msgs/PointCloud2 (Ouster, Velodyne, Hesai, RoboSense, Livox) or Livox's CustomMsg. A topic
need not be named where the bags have but one of its kind. Stamps are those of the headers. How the times of
points were read is told. The body is the IMU; where --T-body-lidar is not given, /tf_static is asked.
Exit codes: 0 all imported, 1 part of it could not be used, 2 wrong usage, 3 wrong input.)";

const std::map<std::string, TimeUnit> kUnits{{"s", TimeUnit::kSeconds},
                                             {"ms", TimeUnit::kMilliseconds},
                                             {"us", TimeUnit::kMicroseconds},
                                             {"ns", TimeUnit::kNanoseconds}};
const std::map<std::string, TimeReference> kReferences{{"stamp", TimeReference::kStamp},
                                                       {"absolute", TimeReference::kAbsolute},
                                                       {"end", TimeReference::kEnd}};

class ImportCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    import_ = app.add_subcommand("import", "Make a rawlog from other recordings");
    import_->require_subcommand(1);
    registerClouds();
    registerKitti();
    registerRosbag();
  }

  bool called() const override { return import_->parsed(); }

  ExitCode run() override {
    output_.compression =
        gzip_ ? RawlogWriter::Compression::kGzip : RawlogWriter::Compression::kNone;
    if (!T_body_lidar_.empty()) scans_.T_body_lidar = parsePose(T_body_lidar_, "--T-body-lidar");
    if (rosbag_command_->parsed() && list_) return listTopics();
    if (output_.file.empty()) throw UsageError("-o is required: the rawlog to write");
    const ImportSummary summary = clouds_command_->parsed()  ? runClouds()
                                  : kitti_command_->parsed() ? runKitti()
                                                             : runRosbag();
    progress_.finish();
    printResult(json_ ? jsonOf(summary).dump(2) + '\n' : tableOf(summary));
    return summary.complete() ? ExitCode::kGood : ExitCode::kDegraded;
  }

 private:
  void registerClouds() {
    CLI::App* c = clouds_command_ = import_->add_subcommand("clouds", "A folder of point clouds");
    c->add_option("DIR", clouds_.folder, "folder of the clouds")->required();
    c->add_option("--times", clouds_.times_file, "names and stamps of the scans")->required();
    c->add_option("--odometry", clouds_.odometry_file, "odometry of the body (TUM)");
    c->add_option("--imu", clouds_.imu_file, "IMU (CSV)");
    addTimes(c);
    addCommon(c);
    c->footer(kCloudsExample);
  }

  void addTimes(CLI::App* c) {
    c->add_option("--time-unit", unit_, "unit of the points' times; else decided from the values")
        ->check(CLI::IsMember(kUnits));
    c->add_option("--time-reference", reference_,
                  "what they count from: the scan's stamp, the stamps' clock (absolute), or "
                  "backwards from the scan's end; else decided from the values")
        ->check(CLI::IsMember(kReferences));
    auto* yes = c->add_flag("--deskewed", deskewed_, "the scans are already deskewed");
    c->add_flag("--not-deskewed", not_deskewed_, "the scans are not deskewed")->excludes(yes);
  }

  void registerRosbag() {
    CLI::App* c = rosbag_command_ = import_->add_subcommand("rosbag", "ROS 1 bags");
    c->add_option("BAG", rosbag_.bags, "bags, read as one")->required();
    c->add_flag("--list", list_, "only list the topics");
    c->add_option("--lidar", rosbag_.lidar, "topic of the scans");
    c->add_option("--imu", rosbag_.imu, "topic of the IMU, or none");
    c->add_option("--odometry", rosbag_.odometry, "topic of the odometry, or none");
    c->add_flag("--imu-in-g", rosbag_.imu_in_g, "accelerations are in g (Livox), not m/s2");
    c->add_flag("--no-covariance", rosbag_.no_covariance, "leave out the odometry's covariance");
    c->add_option("--time-field", rosbag_.time_field,
                  "field of the points' times; else t, time, timestamp, offset_time or time_stamp");
    addTimes(c);
    addCommon(c, false);
    c->footer(kRosbagExample);
  }

  void registerKitti() {
    CLI::App* c = kitti_command_ = import_->add_subcommand("kitti", "A drive of KITTI's raw data");
    c->add_option("DRIVE_DIR", kitti_.drive, "folder of the drive")->required();
    c->add_option("--calib", kitti_.calibration, "folder of calib_imu_to_velo.txt");
    c->add_flag("--azimuth-times", scans_.azimuth_times,
                "give points the time when the spinning LiDAR looked their way");
    addCommon(c);
    c->footer(kKittiExample);
  }

  void addCommon(CLI::App* c, bool output_required = true) {
    c->add_option("-o,--output", output_.file, "rawlog to write")->required(output_required);
    c->add_option("--T-body-lidar", T_body_lidar_,
                  "x,y,z,yaw,pitch,roll (m, degrees) of the LiDAR in the body: p_body = T p_lidar");
    c->add_option("--lidar-label", scans_.label, "sensor label of the scans")
        ->capture_default_str();
    c->add_option("--imu-label", output_.imu_label, "of the IMU")->capture_default_str();
    c->add_option("--odometry-label", output_.odometry_label, "of the odometry")
        ->capture_default_str();
    c->add_flag("--stock", scans_.stock,
                "MRPT's own classes only (with point times, intensities in 8 bits)");
    c->add_flag("--gzip", gzip_, "compress (40 ms a scan)");
    c->add_flag("--overwrite", output_.overwrite, "replace an existing rawlog");
    c->add_flag("--json", json_, "one JSON object on standard output");
  }

  ImportSummary runClouds() {
    if (!unit_.empty()) clouds_.time_unit = kUnits.at(unit_);
    if (!reference_.empty()) clouds_.time_reference = kReferences.at(reference_);
    if (deskewed_) scans_.deskewed = Deskewed::kYes;
    if (not_deskewed_) scans_.deskewed = Deskewed::kNo;
    clouds_.scans = scans_;
    clouds_.output = output_;
    return importClouds(clouds_, [this](double share) { showProgress(share); });
  }

  ImportSummary runKitti() {
    kitti_.has_T_body_lidar = !T_body_lidar_.empty();
    kitti_.scans = scans_;
    kitti_.output = output_;
    return importKitti(kitti_, [this](double share) { showProgress(share); });
  }

  ImportSummary runRosbag() {
    if (!unit_.empty()) rosbag_.time_unit = kUnits.at(unit_);
    if (!reference_.empty()) rosbag_.time_reference = kReferences.at(reference_);
    if (deskewed_) scans_.deskewed = Deskewed::kYes;
    if (not_deskewed_) scans_.deskewed = Deskewed::kNo;
    rosbag_.has_T_body_lidar = !T_body_lidar_.empty();
    rosbag_.scans = scans_;
    rosbag_.output = output_;
    return importRosbag(rosbag_, [this](double share) { showProgress(share); });
  }

  ExitCode listTopics() {
    const auto topics = RosbagReader(rosbag_.bags).topics();
    auto rows = nlohmann::json::array();
    std::string lines;
    for (const auto& t : topics) {
      rows.push_back({{"topic", t.name}, {"type", t.type}, {"messages", t.messages}});
      lines += text(t.name, "  ", t.type, "  ", t.messages, '\n');
    }
    printResult(json_ ? nlohmann::json{{"topics", rows}}.dump(2) + '\n' : lines);
    return ExitCode::kGood;
  }

  void showProgress(double share) {
    char line[40];
    std::snprintf(line, sizeof line, "importing %3.0f %%", 100 * share);
    progress_.show(line);
  }

  CLI::App *import_ = nullptr, *clouds_command_ = nullptr, *kitti_command_ = nullptr,
           *rosbag_command_ = nullptr;
  ImportCloudsSettings clouds_;
  ImportKittiSettings kitti_;
  ImportRosbagSettings rosbag_;
  ScanConversion scans_;
  ImportOutput output_;
  ProgressLine progress_;
  std::string T_body_lidar_, unit_, reference_;
  bool deskewed_ = false, not_deskewed_ = false, gzip_ = false, json_ = false, list_ = false;
};

}  // namespace

std::unique_ptr<Command> makeImportCommand() { return std::make_unique<ImportCommand>(); }

}  // namespace paloc
