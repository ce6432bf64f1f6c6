#include "paloc/tools/import_kitti.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/text.h"
#include "paloc/tools/result_folder.h"

namespace paloc {
namespace {

namespace fs = std::filesystem;

// Line i of a file of times ("2011-09-26 13:02:25.964389445", taken as UTC) is that of file i.
// A line that is empty is a frame that is not there.
using FrameTimes = std::vector<std::optional<TimeNs>>;

bool parseDate(const std::string& line, TimeNs& t_ns) {
  int year = 0;
  unsigned month = 0, day = 0, hour = 0, minute = 0;
  int used = 0;
  if (std::sscanf(line.c_str(), "%4d-%2u-%2u %2u:%2u:%n", &year, &month, &day, &hour, &minute,
                  &used) != 5 ||
      used == 0 || hour > 23 || minute > 59) {
    return false;
  }
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month),
                                         std::chrono::day(day)};
  TimeNs seconds = 0;
  if (!date.ok() ||
      !parseSeconds(std::string_view(line).substr(static_cast<std::size_t>(used)), seconds)) {
    return false;
  }
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  t_ns = ((days * 24LL + hour) * 60LL + minute) * 60LL * kNsPerSecond + seconds;
  return true;
}

FrameTimes readFrameTimes(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw IoError(text(file.string(), ": cannot be opened"));
  FrameTimes times;
  std::string line;
  while (std::getline(in, line)) {
    line.resize(line.find_last_not_of(" \t\r") + 1);
    TimeNs t_ns = 0;
    if (line.empty()) {
      times.emplace_back();
    } else if (parseDate(line, t_ns)) {
      times.emplace_back(t_ns);
    } else {
      throw IoError(
          text(file.string(), ": line ", times.size() + 1, ": '", line, "' is not a time"));
    }
  }
  if (times.empty()) throw IoError(text(file.string(), ": holds no time"));
  return times;
}

fs::path frameFile(const fs::path& folder, std::size_t index, const char* ending) {
  char name[32];
  std::snprintf(name, sizeof(name), "%010zu%s", index, ending);
  return folder / name;
}

// The rotation R and translation T of a calibration file, as a transform.
Pose readCalibration(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw IoError(text(file.string(), ": cannot be opened"));
  Pose pose;
  bool has_rotation = false, has_translation = false;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "R:") {
      for (int i = 0; i < 9; ++i) words >> pose.rotation(i / 3, i % 3);
      has_rotation = static_cast<bool>(words);
    } else if (key == "T:") {
      for (int i = 0; i < 3; ++i) words >> pose.position(i);
      has_translation = static_cast<bool>(words);
    }
  }
  const double error = (pose.rotation * pose.rotation.transpose() - Mat3::Identity()).norm();
  if (!has_rotation || !has_translation || !(error < 1e-3)) {
    throw IoError(text(file.string(), ": has no rotation 'R:' and translation 'T:'"));
  }
  pose.rotation = so3::normalized(pose.rotation);
  return pose;
}

mrpt::poses::CPose3D readExtrinsics(const ImportKittiSettings& settings) {
  if (settings.has_T_body_lidar) return settings.scans.T_body_lidar;
  constexpr const char* kName = "calib_imu_to_velo.txt";
  const fs::path drive = fs::absolute(settings.drive).lexically_normal();
  const fs::path inside = drive.has_filename() ? drive : drive.parent_path();
  for (const auto& folder : {settings.calibration, inside, inside.parent_path()}) {
    if (folder.empty() || !fs::exists(folder / kName)) continue;
    return toMrpt(readCalibration(folder / kName).inverse());  // the file has T_lidar_body
  }
  throw IoError(
      text(settings.drive.string(), ": there is no ", kName,
           " here or in the folder above; name its folder with --calib, or state --T-body-lidar"));
}

std::vector<ScanEntry> listScans(const fs::path& folder, ImportSummary& summary) {
  const FrameTimes forward = readFrameTimes(folder / "timestamps.txt");
  const bool has_ends =
      fs::exists(folder / "timestamps_start.txt") && fs::exists(folder / "timestamps_end.txt");
  const FrameTimes starts = has_ends ? readFrameTimes(folder / "timestamps_start.txt") : forward;
  const FrameTimes ends = has_ends ? readFrameTimes(folder / "timestamps_end.txt") : forward;
  if (starts.size() != forward.size() || ends.size() != forward.size()) {
    throw IoError(text(folder.string(), ": its three files of times differ in length"));
  }
  std::vector<ScanEntry> scans;
  for (std::size_t i = 0; i < forward.size(); ++i) {
    const fs::path file = frameFile(folder / "data", i, ".bin");
    if (!forward[i] || !starts[i] || !ends[i] || !fs::exists(file)) {
      ++summary.not_used["scans that are not there, or have no time"];
      continue;
    }
    ScanEntry scan{file, *starts[i], {}, *forward[i]};
    const bool in_order = *starts[i] <= *forward[i] && *forward[i] <= *ends[i];
    if (has_ends && in_order) scan.last_ns = *ends[i];
    if (!in_order) ++summary.noticed["scans whose start, middle and end are not in order"];
    scans.push_back(std::move(scan));
  }
  if (!has_ends) {
    summary.notes.push_back(
        "there are no timestamps_start.txt and timestamps_end.txt: a scan's stamp "
        "is the instant when the LiDAR looked forward, its length is unknown");
  }
  if (scans.empty()) throw IoError(text(folder.string(), ": holds no scan (data/NNNNNNNNNN.bin)"));
  return scans;
}

// Latitude, longitude (deg), altitude (m), roll, pitch, yaw (rad), ... as dataformat.txt names
// them.
using OxtsPacket = std::array<double, 25>;
enum OxtsField {
  kLat = 0,
  kLon = 1,
  kAlt = 2,
  kRoll = 3,
  kPitch = 4,
  kYaw = 5,
  kAx = 11,
  kWx = 17
};

OxtsPacket readOxts(const fs::path& file) {
  std::ifstream in(file);
  OxtsPacket packet{};
  for (std::size_t i = 0; i < packet.size(); ++i) {
    std::string word;
    in >> word;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, packet[i]);
    if (error != std::errc{} || stop != end || !std::isfinite(packet[i])) {
      throw IoError(
          text(file.string(), ": value ", i + 1, " is not a number ('", word.substr(0, 40), "')"));
    }
  }
  return packet;
}

// The development kit's Mercator projection; x east, y north, z up.
Pose mercatorPose(const OxtsPacket& p, double scale) {
  constexpr double kEarthRadius_m = 6378137;
  constexpr double kRad = std::numbers::pi / 180;
  Pose pose;
  pose.position =
      Vec3(scale * kEarthRadius_m * p[kLon] * kRad,
           scale * kEarthRadius_m * std::log(std::tan((90 + p[kLat]) * kRad / 2)), p[kAlt]);
  pose.rotation = so3::exp(Vec3(0, 0, p[kYaw])) * so3::exp(Vec3(0, p[kPitch], 0)) *
                  so3::exp(Vec3(p[kRoll], 0, 0));
  return pose;
}

void readOxtsFolder(const fs::path& folder, ImportParts& parts, ImportSummary& summary) {
  const FrameTimes times = readFrameTimes(folder / "timestamps.txt");
  std::optional<Pose> T_first_earth;
  double scale = 1;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const fs::path file = frameFile(folder / "data", i, ".txt");
    if (!times[i] || !fs::exists(file)) {
      ++summary.not_used["oxts packets that are not there, or have no time"];
      continue;
    }
    const OxtsPacket p = readOxts(file);
    if (!T_first_earth) {
      scale = std::cos(p[kLat] * std::numbers::pi / 180);
      T_first_earth = mercatorPose(p, scale).inverse();
    }
    parts.imu.push_back(
        {*times[i], Vec3(p[kAx], p[kAx + 1], p[kAx + 2]), Vec3(p[kWx], p[kWx + 1], p[kWx + 2])});
    parts.odometry.push_back({*times[i], *T_first_earth * mercatorPose(p, scale)});
  }
}

}  // namespace

ImportSummary importKitti(const ImportKittiSettings& settings,
                          const std::function<void(double)>& progress) {
  checkNotThere(settings.output.file, settings.output.overwrite);
  ImportSummary summary;
  ImportParts parts;
  ScanConversion how = settings.scans;
  parts.scans = listScans(settings.drive / "velodyne_points", summary);
  readOxtsFolder(settings.drive / "oxts", parts, summary);
  how.T_body_lidar = readExtrinsics(settings);
  how.intensity_scale = 255;  // reflectance is 0..1
  summary.notes.push_back(
      "reflectances (0 to 1) are multiplied by 255; the body is the oxts unit, the odometry "
      "its pose relative to the first");
  if (how.azimuth_times) {
    summary.notes.push_back(
        "times of points come from their direction, as asked for: clockwise seen from above, "
        "forward at timestamps.txt, back at the scan's start and end");
  } else {
    how.deskewed = Deskewed::kNo;
    summary.notes.push_back(
        "KITTI's raw scans are not deskewed and have no times: motion during a scan stays in "
        "them (--azimuth-times takes times from the points' directions)");
  }
  writeRecording(std::move(parts), how, settings.output, progress, summary);
  return summary;
}

}  // namespace paloc
