#pragma once

#include <string>

#include "paloc/map/point_cloud.h"
#include "paloc/tools/ros_messages.h"

namespace paloc {

/// A scan as a ROS message has it. Its points are finite and no zero returns; `cloud.time` is raw.
struct RosCloud {
  TimeNs stamp_ns = 0;  ///< of the header, or a Livox timebase where that is the header's stamp
  std::string frame;
  PointCloud cloud;
  std::size_t zero_dropped = 0;   ///< points at the sensor itself (nothing came back)
  bool timebase_differs = false;  ///< Livox: the timebase is on another clock than the stamp
};

/// Reads a PointCloud2: any order, offset and padding of its fields, x y z as float32 or float64,
/// intensity (also reflectivity, i) and ring (also line, laser) of any type. The time is the field
/// `time_field`, or if empty the first there is of t, time, timestamp, offset_time, time_stamp.
/// Nothing, with a clause in `refusal`, if it cannot be read.
std::optional<RosCloud> readPointCloud2(RosBytes message, const std::string& time_field,
                                        std::string& refusal);

/// Likewise Livox's CustomMsg. offset_time counts from timebase; that differs from the header's
/// stamp by the rounding of a double only, unless its clock is another one: then the stamp is used.
std::optional<RosCloud> readLivoxCustom(RosBytes message, std::string& refusal);

}  // namespace paloc
