#include "paloc/tools/import_clouds.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/map/cloud_io.h"
#include "paloc/tools/imu_csv.h"
#include "paloc/tools/result_folder.h"

namespace paloc {
namespace {

namespace fs = std::filesystem;

bool looksLikeCloud(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".pcd" || ending == ".ply" || ending == ".bin";
}

// The scans that are there, each once, in order of time; counts the rest.
std::vector<ScanEntry> presentScans(const ImportCloudsSettings& settings, ImportSummary& summary) {
  if (!fs::is_directory(settings.folder)) {
    throw IoError(text(settings.folder.string(), ": is not a folder"));
  }
  std::vector<ScanEntry> present;
  std::set<fs::path> listed;
  for (auto& scan : readScanTimes(settings.times_file, settings.folder)) {
    if (!listed.insert(scan.file.lexically_normal()).second) {
      ++summary.not_used["scans listed twice"];
    } else if (!fs::exists(scan.file)) {
      ++summary.not_used["scans listed, but not there"];
    } else {
      present.push_back(std::move(scan));
    }
  }
  for (const auto& item : fs::directory_iterator(settings.folder)) {
    const bool unlisted = !listed.contains(item.path().lexically_normal());
    if (unlisted && looksLikeCloud(item.path())) ++summary.not_used["clouds without a time"];
  }
  if (present.empty()) {
    throw IoError(text(settings.folder.string(), ": none of the scans that ",
                       settings.times_file.string(), " lists is there"));
  }
  const auto earlier = [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; };
  for (std::size_t i = 1; i < present.size(); ++i) {
    if (earlier(present[i], present[i - 1])) {
      ++summary.noticed["scan stamps going backwards (put in order)"];
    } else if (present[i].stamp_ns == present[i - 1].stamp_ns) {
      ++summary.noticed["scans with the stamp of the one before"];
    }
  }
  std::stable_sort(present.begin(), present.end(), earlier);
  return present;
}

std::vector<TimeNs> stampsOf(const std::vector<ScanEntry>& scans) {
  std::vector<TimeNs> stamps;
  for (const ScanEntry& scan : scans) stamps.push_back(scan.stamp_ns);
  return stamps;
}

// Looks into some scans, evenly spread, and decides how times and intensities are to be read.
void decideReading(const std::vector<ScanEntry>& scans, const ImportCloudsSettings& settings,
                   ScanConversion& how, ImportSummary& summary) {
  constexpr std::size_t kLookedInto = 15;
  std::vector<PointTimeSample> samples;
  float max_intensity = 0;
  bool whole_numbers = true;
  const std::size_t step = std::max<std::size_t>(1, scans.size() / kLookedInto);
  for (std::size_t i = 0; i < scans.size(); i += step) {
    PointCloud cloud;
    try {
      cloud = loadCloud(scans[i].file);
    } catch (const IoError&) {
      continue;  // counted when its turn comes to be written
    }
    for (const float v : cloud.intensity) {
      if (std::isfinite(v)) max_intensity = std::max(max_intensity, v);
      whole_numbers = whole_numbers && v == std::floor(v);
    }
    std::erase_if(cloud.time, [](double v) { return !std::isfinite(v); });
    if (cloud.time.empty()) continue;
    const auto [low, high] = std::minmax_element(cloud.time.begin(), cloud.time.end());
    samples.push_back({scans[i].stamp_ns, *low, *high, cloud.time_field, cloud.time_is_integer});
  }
  if (max_intensity > 0 && max_intensity <= 1 && !whole_numbers) {
    how.intensity_scale = 255;
    summary.notes.emplace_back("intensities lie between 0 and 1: multiplied by 255");
  }
  if (!samples.empty()) {
    how.times = decidePointTimes(samples, scanPeriod(stampsOf(scans)), settings.time_unit,
                                 settings.time_reference);
    summary.notes.push_back(how.times->sentence);
  }
}

void noteDeskewing(const std::vector<ScanEntry>& scans, const ScanConversion& how,
                   ImportSummary& summary) {
  if (how.times) return;
  const bool ends =
      std::any_of(scans.begin(), scans.end(), [](const auto& s) { return s.last_ns; });
  if (how.deskewed == Deskewed::kYes) {
    summary.notes.emplace_back("points have no times: the scans are deskewed, as stated");
  } else if (how.deskewed == Deskewed::kNo) {
    summary.notes.emplace_back(
        "points have no times, and the scans are not deskewed, as stated: "
        "motion during a scan cannot be undone");
  } else if (ends) {
    summary.notes.emplace_back(
        "points have no times, but scans have an end: taken as not deskewed "
        "(--deskewed if they are)");
  } else {
    summary.notes.emplace_back(
        "points have no times and scans no end: taken as deskewed to their "
        "stamp (--not-deskewed if they are not)");
  }
}

}  // namespace

ImportSummary importClouds(const ImportCloudsSettings& settings,
                           const std::function<void(double)>& progress) {
  checkNotThere(settings.output.file, settings.output.overwrite);
  ImportSummary summary;
  ImportParts parts;
  ScanConversion how = settings.scans;
  parts.scans = presentScans(settings, summary);
  if (!settings.odometry_file.empty()) parts.odometry = readTum(settings.odometry_file);
  if (!settings.imu_file.empty()) {
    ImuCsv imu = readImuCsv(settings.imu_file);
    parts.imu = std::move(imu.samples);
    if (imu.nonfinite > 0) summary.not_used["IMU samples that are not finite"] = imu.nonfinite;
    if (!imu.other_columns.empty()) {
      summary.notes.push_back(
          text("columns of the IMU's file that are not read: ", imu.other_columns));
    }
    noteImuUnit(parts.imu, summary);
  }
  decideReading(parts.scans, settings, how, summary);
  noteDeskewing(parts.scans, how, summary);
  writeRecording(std::move(parts), how, settings.output, progress, summary);
  return summary;
}

}  // namespace paloc
