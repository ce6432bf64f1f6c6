#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cmath>

#include "lidar_decoders.h"

// A file of its own: this header costs three seconds of compilation.
namespace paloc::lidar_decoders {
namespace {

using mrpt::obs::CObservation3DRangeScan;

void addPoint(LidarFrame& frame, float x, float y, float z) {
  const bool finite = std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
  if (finite && (x != 0 || y != 0 || z != 0)) {
    frame.points_lidar.push_back({x, y, z});
  } else {
    ++frame.invalid_points;
  }
}

// The pinhole model as MRPT documents it for this class: x forward, y left, z up.
bool unproject(const CObservation3DRangeScan& scan, LidarFrame& frame, std::string& refusal) {
  const auto& camera = scan.cameraParams;
  if (!(camera.fx() > 0) || !(camera.fy() > 0) || !(scan.rangeUnits > 0)) {
    refusal = "its camera has no focal length or range unit";
    return false;
  }
  for (int row = 0; row < scan.rangeImage.rows(); ++row) {
    const double kz = (camera.cy() - row) / camera.fy();
    for (int col = 0; col < scan.rangeImage.cols(); ++col) {
      const double ky = (camera.cx() - col) / camera.fx();
      double depth = scan.rangeImage(row, col) * static_cast<double>(scan.rangeUnits);
      if (!scan.range_is_depth) depth /= std::sqrt(1 + ky * ky + kz * kz);
      addPoint(frame, static_cast<float>(depth), static_cast<float>(ky * depth),
               static_cast<float>(kz * depth));
    }
  }
  return true;
}

}  // namespace

bool decodeRangeCamera(const mrpt::obs::CObservation& observation, LidarColumns, LidarFrame& frame,
                       std::string& refusal) {
  const auto& scan = dynamic_cast<const CObservation3DRangeScan&>(observation);
  scan.load();
  frame.deskewed = true;
  frame.time_policy = "a range camera takes its image at once: taken as deskewed to the stamp";
  if (scan.hasPoints3D) {
    const std::size_t n = scan.points3D_x.size();
    if (scan.points3D_y.size() != n || scan.points3D_z.size() != n) {
      refusal = "its columns differ in length";
      return false;
    }
    for (std::size_t i = 0; i < n; ++i) {
      addPoint(frame, scan.points3D_x[i], scan.points3D_y[i], scan.points3D_z[i]);
    }
    return true;
  }
  if (scan.hasRangeImage) return unproject(scan, frame, refusal);
  refusal = "it holds neither points nor a range image";
  return false;
}

}  // namespace paloc::lidar_decoders
