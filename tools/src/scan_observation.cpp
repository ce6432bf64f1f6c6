#include "paloc/tools/scan_observation.h"

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/frontends/mrpt_time.h"

namespace paloc {
namespace {

constexpr TimeNs kTick = 100;  // of MRPT's clock
constexpr TimeNs kLongest = std::numeric_limits<std::uint32_t>::max();

std::vector<TimeNs> timesOf(const PointCloud& cloud, const ScanEntry& entry,
                            const ScanConversion& how) {
  if (how.azimuth_times && entry.last_ns && entry.forward_ns) {
    return timesByAzimuth(cloud, entry.stamp_ns, *entry.forward_ns, *entry.last_ns);
  }
  if (!how.times || cloud.time.empty()) return {};
  return readPointTimes(*how.times, cloud.time, entry.stamp_ns, entry.last_ns);
}

template <typename T>
T clamped(double value) {
  constexpr double kMax = std::numeric_limits<T>::max();
  return std::isfinite(value) ? static_cast<T>(std::clamp(std::round(value), 0.0, kMax)) : T{0};
}

// The stamp is the first point's: the stated one, unless a point is earlier. To MRPT's clock tick,
// downwards, so that no point comes before it.
TimeNs firstStamp(const std::vector<TimeNs>& times, TimeNs stated, ScanCounts& counts) {
  constexpr TimeNs kRounding = 2000;  // stamps are often stated to the microsecond
  TimeNs first = stated;
  for (const TimeNs t : times) {
    if (t != kNoTime && t < first && stated - t <= kLongest) first = t;
  }
  counts.began_earlier = stated - first > kRounding;
  return first - ((first % kTick) + kTick) % kTick;
}

std::shared_ptr<obs::CObservationLidarScan> makeOurs(const PointCloud& cloud,
                                                     const ScanEntry& entry,
                                                     const ScanConversion& how,
                                                     ScanCounts& counts) {
  const std::vector<TimeNs> times = timesOf(cloud, entry, how);
  auto scan = std::make_shared<obs::CObservationLidarScan>();
  const TimeNs first = firstStamp(times, entry.stamp_ns, counts);
  scan->timestamp = toMrptTime(first);
  scan->sensorLabel = how.label;
  scan->sensorPoseOnRobot = how.T_body_lidar;
  const std::size_t n = cloud.size();
  for (auto* axis : {&scan->x, &scan->y, &scan->z}) axis->reserve(n);
  TimeNs last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!times.empty()) {
      if (times[i] == kNoTime || times[i] < first || times[i] - first > kLongest) {
        ++counts.bad_times;
        continue;
      }
      last = std::max(last, times[i] - first);
      scan->dt_ns.push_back(static_cast<std::uint32_t>(times[i] - first));
    }
    const Point3f& p = cloud.points[i];
    scan->x.push_back(static_cast<float>(cloud.origin.x() + static_cast<double>(p.x)));
    scan->y.push_back(static_cast<float>(cloud.origin.y() + static_cast<double>(p.y)));
    scan->z.push_back(static_cast<float>(cloud.origin.z() + static_cast<double>(p.z)));
    if (!cloud.intensity.empty()) {
      const double scaled = how.intensity_scale * static_cast<double>(cloud.intensity[i]);
      scan->intensity.push_back(clamped<std::uint16_t>(scaled));
    }
    if (!cloud.ring.empty()) scan->ring.push_back(cloud.ring[i]);
  }
  if (entry.last_ns) last = std::max(last, *entry.last_ns - first);
  scan->duration_ns = static_cast<std::uint32_t>(std::min(last, kLongest));
  const bool guess = times.empty() && !entry.last_ns;
  scan->deskewed = how.deskewed == Deskewed::kYes || (how.deskewed == Deskewed::kGuess && guess);
  counts.points = scan->size();
  counts.has_times = !scan->dt_ns.empty();
  counts.deskewed = scan->deskewed;
  return scan;
}

mrpt::obs::CObservation::Ptr asVelodyneCloud(const obs::CObservationLidarScan& scan) {
  auto stock = mrpt::obs::CObservationVelodyneScan::Create();
  auto& cloud = stock->point_cloud;
  cloud.x = scan.x;
  cloud.y = scan.y;
  cloud.z = scan.z;
  for (const std::uint16_t v : scan.intensity) cloud.intensity.push_back(clamped<std::uint8_t>(v));
  for (const std::uint16_t v : scan.ring) cloud.laser_id.push_back(clamped<std::int16_t>(v));
  const TimeNs first = fromMrptTime(scan.timestamp);
  for (const std::uint32_t dt : scan.dt_ns) cloud.timestamp.push_back(toMrptTime(first + dt));
  return stock;
}

mrpt::obs::CObservation::Ptr asPointCloud(const obs::CObservationLidarScan& scan) {
  auto stock = mrpt::obs::CObservationPointCloud::Create();
  const auto fillPoints = [&scan](mrpt::maps::CPointsMap& map) {
    map.resize(scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) {
      map.setPointFast(i, scan.x[i], scan.y[i], scan.z[i]);
    }
  };
  if (scan.intensity.empty()) {
    auto map = mrpt::maps::CSimplePointsMap::Create();
    fillPoints(*map);
    stock->pointcloud = map;
  } else {
    auto map = mrpt::maps::CPointsMapXYZI::Create();
    fillPoints(*map);
    for (std::size_t i = 0; i < scan.size(); ++i) map->setPointIntensity(i, scan.intensity[i]);
    stock->pointcloud = map;
  }
  return stock;
}

}  // namespace

std::vector<TimeNs> timesByAzimuth(const PointCloud& cloud, TimeNs first_ns, TimeNs forward_ns,
                                   TimeNs last_ns) {
  std::vector<TimeNs> times(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double x = cloud.origin.x() + static_cast<double>(cloud.points[i].x);
    const double y = cloud.origin.y() + static_cast<double>(cloud.points[i].y);
    const double turn = -std::atan2(y, x) / std::numbers::pi;  // -1 at the back, 0 forward, 1 back
    const TimeNs way = turn < 0 ? forward_ns - first_ns : last_ns - forward_ns;
    times[i] = forward_ns + std::llround(turn * static_cast<double>(way));
  }
  return times;
}

mrpt::obs::CObservation::Ptr makeScanObservation(const PointCloud& cloud, const ScanEntry& entry,
                                                 const ScanConversion& how, ScanCounts& counts) {
  const auto scan = makeOurs(cloud, entry, how, counts);
  if (!how.stock) return scan;
  auto stock = scan->dt_ns.empty() ? asPointCloud(*scan) : asVelodyneCloud(*scan);
  stock->timestamp = scan->timestamp;
  stock->sensorLabel = scan->sensorLabel;
  stock->setSensorPose(scan->sensorPoseOnRobot);
  return stock;
}

}  // namespace paloc
