#pragma once

#include <mrpt/obs/CObservation.h>

#include <optional>
#include <string>

#include "paloc/map/point_cloud.h"
#include "paloc/tools/point_times.h"
#include "paloc/tools/scan_times_file.h"

namespace paloc {

/// Whether the points of a scan without times are as seen from one instant.
enum class Deskewed { kGuess, kYes, kNo };

/// How clouds become observations.
struct ScanConversion {
  std::string label = "lidar";
  mrpt::poses::CPose3D T_body_lidar;
  std::optional<PointTimeRule> times;  ///< nothing: clouds have no times
  bool azimuth_times = false;          ///< KITTI: times from the direction of the points
  Deskewed deskewed = Deskewed::kGuess;
  double intensity_scale = 1;  ///< to the observation's integers
  bool stock = false;          ///< MRPT's own classes only
};

/// What is to be counted of one scan.
struct ScanCounts {
  std::size_t points = 0;
  std::size_t bad_times = 0;  ///< points left out: their time is not finite or does not fit
  bool has_times = false;
  bool deskewed = false;
  bool began_earlier = false;  ///< a point's time lies before the stated stamp, which was moved
};

/// Makes the observation of a scan: CObservationLidarScan, or with `stock`
/// CObservationVelodyneScan (with its point_cloud, where points have times) or
/// CObservationPointCloud.
mrpt::obs::CObservation::Ptr makeScanObservation(const PointCloud& cloud, const ScanEntry& entry,
                                                 const ScanConversion& how, ScanCounts& counts);

/// Times of a spinning LiDAR's points by their direction: clockwise seen from above, beginning and
/// ending at the back, looking along +x at `forward_ns`.
std::vector<TimeNs> timesByAzimuth(const PointCloud& cloud, TimeNs first_ns, TimeNs forward_ns,
                                   TimeNs last_ns);

}  // namespace paloc
