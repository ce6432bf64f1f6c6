#include "paloc/tools/import_recording.h"

#include <algorithm>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/text.h"
#include "paloc/map/cloud_io.h"
#include "paloc/tools/motion_observations.h"

namespace paloc {
namespace {

enum class Kind { kImu, kOdometry, kScan };  // also the order at equal stamps

struct Entry {
  TimeNs t_ns;
  Kind kind;
  std::size_t index;
};

// In order of time, equal stamps once; counts what it changes.
template <typename Sample>
void putInOrder(std::vector<Sample>& samples, const std::string& what, ImportSummary& summary) {
  const auto earlier = [](const Sample& a, const Sample& b) { return a.t_ns < b.t_ns; };
  std::uint64_t backwards = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    backwards += earlier(samples[i], samples[i - 1]) ? 1 : 0;
  }
  std::stable_sort(samples.begin(), samples.end(), earlier);
  const auto end = std::unique(samples.begin(), samples.end(),
                               [](const Sample& a, const Sample& b) { return a.t_ns == b.t_ns; });
  const auto repeated = static_cast<std::uint64_t>(samples.end() - end);
  samples.erase(end, samples.end());
  if (backwards > 0) summary.noticed[what + " that go back in time (put in order)"] += backwards;
  if (repeated > 0) summary.not_used[what + " with the stamp of another"] += repeated;
}

std::vector<Entry> merged(const ImportParts& parts) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < parts.imu.size(); ++i) {
    entries.push_back({parts.imu[i].t_ns, Kind::kImu, i});
  }
  for (std::size_t i = 0; i < parts.odometry.size(); ++i) {
    entries.push_back({parts.odometry[i].t_ns, Kind::kOdometry, i});
  }
  for (std::size_t i = 0; i < parts.scans.size(); ++i) {
    entries.push_back({parts.scans[i].stamp_ns, Kind::kScan, i});
  }
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.t_ns != b.t_ns ? a.t_ns < b.t_ns : a.kind < b.kind;
  });
  return entries;
}

// Writes one scan, or counts why not.
void writeScan(const ImportParts& parts, const ScanEntry& entry, const ScanConversion& how,
               RawlogWriter& writer, ImportSummary& summary) {
  PointCloud cloud;
  try {
    cloud = parts.load ? parts.load(entry) : loadCloud(entry.file);
  } catch (const IoError& e) {
    constexpr std::uint64_t kTold = 3;
    const std::uint64_t count = ++summary.not_used["scans that cannot be read"];
    if (count <= kTold) summary.notes.push_back(text("not read: ", e.what()));
    return;
  }
  ScanCounts counts;
  writer.write(*makeScanObservation(cloud, entry, how, counts));
  ++summary.scans;
  summary.points += counts.points;
  summary.scans_with_times += counts.has_times ? 1 : 0;
  summary.scans_deskewed += counts.deskewed ? 1 : 0;
  if (how.times && !counts.has_times) ++summary.noticed["scans without the field of times"];
  if (counts.began_earlier) ++summary.noticed["scans with points before their stamp (stamp moved)"];
  if (counts.bad_times > 0) {
    summary.not_used["points whose time is not finite or does not fit"] += counts.bad_times;
  }
  if (cloud.nonfinite_dropped > 0) {
    summary.noticed["points that are not finite (left out)"] += cloud.nonfinite_dropped;
  }
}

mrpt::obs::CObservationRobotPose odometryObservation(const ImportParts& parts,
                                                     const StampedPose& pose,
                                                     const ImportOutput& output) {
  auto observation = poseObservation(pose, output.odometry_label);
  const auto covariance = parts.odometry_covariances.find(pose.t_ns);
  if (covariance != parts.odometry_covariances.end()) {
    observation.pose = toMrpt(pose.pose, covariance->second);
  }
  observation.sensorPose = toMrpt(parts.T_body_odometry);
  return observation;
}

}  // namespace

void noteImuUnit(const std::vector<ImuSample>& imu, ImportSummary& summary) {
  double sum = 0;
  for (const auto& sample : imu) sum += sample.acc_body.norm();
  const double mean = sum / static_cast<double>(imu.size());
  if (mean > 0.8 && mean < 1.25) {
    summary.notes.emplace_back(
        "the IMU's mean specific force is near 1: it looks like g, but is taken as m/s2");
  }
}

void writeRecording(ImportParts parts, const ScanConversion& how, const ImportOutput& output,
                    const std::function<void(double)>& progress, ImportSummary& summary) {
  putInOrder(parts.imu, "IMU samples", summary);
  putInOrder(parts.odometry, "odometry poses", summary);
  const std::vector<Entry> entries = merged(parts);
  RawlogWriter writer(output.file, output.compression);
  std::size_t done = 0;
  for (const Entry& entry : entries) {
    switch (entry.kind) {
      case Kind::kImu:
        writer.write(imuObservation(parts.imu[entry.index], output.imu_label));
        break;
      case Kind::kOdometry:
        writer.write(odometryObservation(parts, parts.odometry[entry.index], output));
        break;
      case Kind::kScan:
        writeScan(parts, parts.scans[entry.index], how, writer, summary);
        progress(static_cast<double>(done) / static_cast<double>(entries.size()));
        break;
    }
    ++done;
  }
  writer.close();
  if (summary.scans == 0) {
    throw IoError(text("no scan could be read", summary.notes.empty() ? "" : "; ",
                       summary.notes.empty() ? "" : summary.notes.back()));
  }
  summary.output = output.file.string();
  summary.bytes = std::filesystem::file_size(output.file);
  summary.imu_samples = parts.imu.size();
  summary.odometry_poses = parts.odometry.size();
  summary.duration_s = secondsBetween(entries.front().t_ns, entries.back().t_ns);
}

}  // namespace paloc
