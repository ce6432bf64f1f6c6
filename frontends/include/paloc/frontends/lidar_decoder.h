#pragma once

#include <mrpt/obs/CObservation.h>

#include <optional>
#include <string>

#include "paloc/core/export.h"
#include "paloc/frontends/lidar_frame.h"

namespace paloc {

/// What a reader of scans wants besides points and times. Unwanted columns are not filled.
struct LidarColumns {
  bool intensity = false;
  bool ring = false;
};

/// Whether this is a scan of a class that decodeLidar() reads: CObservationLidarScan (ours),
/// CObservationVelodyneScan, CObservationRotatingScan, CObservationPointCloud,
/// CObservation3DRangeScan.
PALOC_EXPORT bool isLidar(const mrpt::obs::CObservation& observation);

/// Reads a scan. Returns nothing, with the reason as a short clause in `refusal`, if it cannot be
/// read. Externally stored clouds are loaded, and stay loaded. `recycled` gives its memory to the
/// result: pages that are new to the process cost as much as the decoding itself.
PALOC_EXPORT std::optional<LidarFrame> decodeLidar(const mrpt::obs::CObservation& observation,
                                                   LidarColumns columns, std::string& refusal,
                                                   LidarFrame recycled = {});

}  // namespace paloc
