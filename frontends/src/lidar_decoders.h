#pragma once

#include <string>

#include "paloc/frontends/lidar_decoder.h"

/// One decoder for each class of observation. Each fills the points, times and time policy of
/// `frame`, whose stamp, label and pose are set; false with a reason in `refusal` if it cannot.
namespace paloc::lidar_decoders {

bool decodeLidarScan(const mrpt::obs::CObservation& observation, LidarColumns columns,
                     LidarFrame& frame, std::string& refusal);
bool decodeVelodyneScan(const mrpt::obs::CObservation& observation, LidarColumns columns,
                        LidarFrame& frame, std::string& refusal);
bool decodeRotatingScan(const mrpt::obs::CObservation& observation, LidarColumns columns,
                        LidarFrame& frame, std::string& refusal);
bool decodePointCloud(const mrpt::obs::CObservation& observation, LidarColumns columns,
                      LidarFrame& frame, std::string& refusal);
bool decodeRangeCamera(const mrpt::obs::CObservation& observation, LidarColumns columns,
                       LidarFrame& frame, std::string& refusal);

}  // namespace paloc::lidar_decoders
