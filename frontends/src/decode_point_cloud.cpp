#include <mrpt/maps/CPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>

#include "lidar_decoders.h"

namespace paloc::lidar_decoders {

bool decodePointCloud(const mrpt::obs::CObservation& observation, LidarColumns columns,
                      LidarFrame& frame, std::string& refusal) {
  const auto& scan = dynamic_cast<const mrpt::obs::CObservationPointCloud&>(observation);
  scan.load();
  if (!scan.pointcloud) {
    refusal = "it holds no cloud";
    return false;
  }
  const auto& x = scan.pointcloud->getPointsBufferRef_x();
  const auto& y = scan.pointcloud->getPointsBufferRef_y();
  const auto& z = scan.pointcloud->getPointsBufferRef_z();
  const auto* with_intensity =
      dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(scan.pointcloud.get());
  const bool intensity = columns.intensity && with_intensity;
  frame.points_lidar.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool finite = std::isfinite(x[i]) && std::isfinite(y[i]) && std::isfinite(z[i]);
    if (!finite || (x[i] == 0 && y[i] == 0 && z[i] == 0)) {
      ++frame.invalid_points;
      continue;
    }
    frame.points_lidar.push_back({x[i], y[i], z[i]});
    if (intensity) frame.intensity.push_back(with_intensity->getPointIntensity(i));
  }
  // The class has no room for times. Whoever wants deskewing has to record one that has.
  frame.deskewed = true;
  frame.time_policy = "its class has no time for each point: taken as deskewed to the stamp";
  return true;
}

}  // namespace paloc::lidar_decoders
