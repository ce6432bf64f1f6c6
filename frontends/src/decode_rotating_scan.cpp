#include <mrpt/obs/CObservationRotatingScan.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lidar_decoders.h"
#include "velodyne_model.h"

namespace paloc::lidar_decoders {
namespace {

using mrpt::obs::CObservationRotatingScan;

// The class holds no elevation angles: they follow from the model's name.
const velodyne::Model* modelOf(const CObservationRotatingScan& scan) {
  for (const auto* model : {&velodyne::kVlp16, &velodyne::kHdl32}) {
    if (scan.lidarModel == model->name && scan.rowCount == model->lasers) return model;
  }
  return nullptr;
}

// The range image by columns, in the order in which they were fired.
struct Geometry {
  int columns = 0;   // that can hold returns
  double start = 0;  // rad, counter-clockwise from forward
  double step = 0;   // rad a column
  double seconds_per_column = 0;
};

// MRPT's fromVelodyne() gives the image a column for each laser of a firing and fills one for each
// firing; its azimuths are Velodyne's, clockwise. Known by the model's name, which it alone writes
// so. Other images are what the class says: even columns, the span from the first to the last.
Geometry geometryOf(const CObservationRotatingScan& scan, const velodyne::Model* model) {
  Geometry g;
  g.columns = scan.columnCount;
  double sense = 1;
  int steps = std::max(1, g.columns - 1);
  if (model && scan.columnCount % (32 * 12) == 0) {
    g.columns = scan.columnCount / model->lasers;
    sense = -1;
    steps = g.columns;
  }
  g.start = sense * scan.startAzimuth;
  g.step = sense * scan.azimuthSpan / steps;
  g.seconds_per_column = scan.sweepDuration / steps;
  return g;
}

bool check(const CObservationRotatingScan& scan, const velodyne::Model* model,
           std::string& refusal) {
  const auto& image = scan.rangeImage;
  if (image.rows() != scan.rowCount || image.cols() != scan.columnCount || scan.columnCount == 0) {
    refusal = "its range image does not have the size it tells";
  } else if (!(scan.rangeResolution > 0) || !std::isfinite(scan.startAzimuth) ||
             !std::isfinite(scan.azimuthSpan) || !(std::abs(scan.sweepDuration) < 4)) {
    refusal = "its resolution, azimuth or duration is not sensible";
  } else if (!model && scan.rowCount != 1) {
    refusal = "its class has no elevation angles, and those of '" + scan.lidarModel +
              "' are not known here";
  } else {
    return true;
  }
  return false;
}

}  // namespace

bool decodeRotatingScan(const mrpt::obs::CObservation& observation, LidarColumns columns,
                        LidarFrame& frame, std::string& refusal) {
  const auto& scan = dynamic_cast<const CObservationRotatingScan&>(observation);
  const velodyne::Model* model = modelOf(scan);
  if (!check(scan, model, refusal)) return false;
  const Geometry g = geometryOf(scan, model);
  const bool times = scan.sweepDuration > 0;
  const bool intensity = columns.intensity && scan.intensityImage.rows() == scan.rowCount &&
                         scan.intensityImage.cols() == scan.columnCount;
  for (int col = 0; col < g.columns; ++col) {
    for (int row = 0; row < scan.rowCount; ++row) {
      const double range = scan.rangeImage(row, col) * scan.rangeResolution;
      if (range == 0) {
        ++frame.invalid_points;
        continue;
      }
      // Within a firing the lasers follow one another while the head turns on.
      const double within =
          model ? static_cast<double>(row * model->laser_ns) / static_cast<double>(model->firing_ns)
                : 0.0;
      const double azimuth = g.start + (col + within) * g.step;
      const double elevation =
          model ? model->elevation_deg[static_cast<std::size_t>(row)] * std::numbers::pi / 180
                : 0.0;
      const double xy = range * std::cos(elevation);
      frame.points_lidar.push_back({static_cast<float>(xy * std::cos(azimuth)),
                                    static_cast<float>(xy * std::sin(azimuth)),
                                    static_cast<float>(range * std::sin(elevation))});
      if (times) {
        frame.dt_ns.push_back(
            static_cast<std::uint32_t>(nsFromSeconds((col + within) * g.seconds_per_column)));
      }
      if (intensity) frame.intensity.push_back(scan.intensityImage(row, col));
      if (columns.ring) frame.ring.push_back(static_cast<std::uint16_t>(row));
    }
  }
  frame.deskewed = !times;
  frame.duration_ns = times ? nsFromSeconds(scan.sweepDuration) : 0;
  frame.time_policy = times ? "points have the times of their columns, even over the sweep"
                            : "the sweep has no duration: taken as deskewed to the stamp";
  return true;
}

}  // namespace paloc::lidar_decoders
