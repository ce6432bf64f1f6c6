#include "paloc/frontends/lidar_decoder.h"

#include <mrpt/rtti/CObject.h>

#include <array>
#include <exception>
#include <string_view>

#include "lidar_decoders.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/mrpt_time.h"

namespace paloc {
namespace {

using Decode = bool (*)(const mrpt::obs::CObservation&, LidarColumns, LidarFrame&, std::string&);

struct Decoder {
  std::string_view class_name;
  Decode decode;
};

constexpr std::array<Decoder, 5> kDecoders = {{
    {"paloc::obs::CObservationLidarScan", lidar_decoders::decodeLidarScan},
    {"mrpt::obs::CObservationVelodyneScan", lidar_decoders::decodeVelodyneScan},
    {"mrpt::obs::CObservationRotatingScan", lidar_decoders::decodeRotatingScan},
    {"mrpt::obs::CObservationPointCloud", lidar_decoders::decodePointCloud},
    {"mrpt::obs::CObservation3DRangeScan", lidar_decoders::decodeRangeCamera},
}};

// By name, so that asking does not pull in the headers of all the classes.
const Decoder* decoderOf(const mrpt::obs::CObservation& observation) {
  const std::string_view name = observation.GetRuntimeClass()->className;
  for (const Decoder& decoder : kDecoders) {
    const std::string_view full = decoder.class_name;
    if (name == full || name == full.substr(full.rfind(':') + 1)) return &decoder;
  }
  return nullptr;
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

bool isLidar(const mrpt::obs::CObservation& observation) {
  return decoderOf(observation) != nullptr;
}

std::optional<LidarFrame> decodeLidar(const mrpt::obs::CObservation& observation,
                                      LidarColumns columns, std::string& refusal,
                                      LidarFrame recycled) {
  const Decoder* decoder = decoderOf(observation);
  if (!decoder) {
    refusal = "not a LiDAR scan";
    return std::nullopt;
  }
  LidarFrame frame = std::move(recycled);
  frame.stamp_ns = fromMrptTime(observation.timestamp);
  frame.duration_ns = 0;
  frame.deskewed = false;
  frame.class_name = decoder->class_name.substr(decoder->class_name.rfind(':') + 1);
  frame.label = observation.sensorLabel;
  frame.time_policy.clear();
  frame.points_lidar.clear();
  frame.dt_ns.clear();
  frame.intensity.clear();
  frame.ring.clear();
  frame.invalid_points = 0;
  mrpt::poses::CPose3D pose;
  observation.getSensorPose(pose);
  frame.T_body_lidar = fromMrpt(pose);
  if (!frame.T_body_lidar.position.allFinite() || !frame.T_body_lidar.rotation.allFinite()) {
    refusal = "its sensor pose is not finite";
    return std::nullopt;
  }
  try {
    if (!decoder->decode(observation, columns, frame, refusal)) return std::nullopt;
  } catch (const std::exception& e) {
    // MRPT's readers of external files throw texts of many lines.
    refusal = "cannot be read: " + firstLine(e.what());
    return std::nullopt;
  }
  return frame;
}

}  // namespace paloc
