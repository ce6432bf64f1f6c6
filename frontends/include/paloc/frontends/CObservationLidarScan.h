#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <cstdint>
#include <vector>

#include "paloc/core/export.h"

namespace paloc::obs {

/// A LiDAR scan with a time for each point, whole and quick to read: what Debian's MRPT has no
/// class for. `timestamp` is that of the first point. rawlog-edit and RawLogViewer read it with
/// `-p`/`-l libpaloc_frontends.so`.
class PALOC_EXPORT CObservationLidarScan : public mrpt::obs::CObservation {
  DEFINE_SERIALIZABLE(CObservationLidarScan, paloc::obs)

 public:
  mrpt::poses::CPose3D sensorPoseOnRobot;  ///< T_body_lidar

  /// Points in the sensor's frame (m); as seen from the instant stamp + duration if `deskewed`.
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> dt_ns;      ///< after `timestamp`; empty if unknown
  std::vector<std::uint16_t> intensity;  ///< empty, or one per point; in the sensor's unit
  std::vector<std::uint16_t> ring;       ///< empty, or one per point
  std::uint32_t duration_ns = 0;         ///< from the first to the last firing of the scan
  bool deskewed = false;

  std::size_t size() const { return x.size(); }

  void getSensorPose(mrpt::poses::CPose3D& out) const override { out = sensorPoseOnRobot; }
  void setSensorPose(const mrpt::poses::CPose3D& pose) override { sensorPoseOnRobot = pose; }
  void getDescriptionAsText(std::ostream& out) const override;
};

}  // namespace paloc::obs
