#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "paloc/core/export.h"
#include "paloc/map/point_cloud.h"

namespace paloc {

/// How a cloud is read.
struct LoadOptions {
  /// Above 0: thinned while it is read, to the centroid of the points in each voxel of this edge
  /// (of a grid about the cloud's origin), with their mean intensity; rings and times are left
  /// out. A file of any size then takes the memory of its voxels.
  double voxel_m = 0;
  std::function<void(double share)> progress{};  ///< called now and then with what is done, 0..1
  std::uint64_t memory_limit_bytes = 0;          ///< 0: what the machine has free
};

/// Reads a point cloud; the format is told by the file's first bytes, and by its ending for formats
/// without a signature:
/// - PLY: ascii, binary_little_endian, binary_big_endian;
/// - PCD: ascii, binary, binary_compressed;
/// - LAS 1.0 to 1.4, point formats 0 to 10 (LAZ is refused);
/// - text with one point a line (.xyz, .txt, .asc, .csv, .pts, ...), columns apart by blanks, tabs,
///   commas or semicolons, with or without a line of names;
/// - OctoMap .bt and .ot: a point in the middle of each occupied cell that borders free space;
/// - KITTI .bin (x y z intensity, float32);
/// - any of these gzipped (.ply.gz), unpacked in memory.
/// Non-finite points are left out and counted. Before memory is taken for the points, it is
/// compared with what there is. Throws IoError with one sentence (file, line or byte, field) for
/// anything else.
PALOC_EXPORT PointCloud loadCloud(const std::filesystem::path& file,
                                  const LoadOptions& options = {});

/// Writes a binary PCD with the same fields. Throws IoError.
PALOC_EXPORT void savePcd(const std::filesystem::path& file, const PointCloud& cloud);

/// Writes a binary little-endian PLY with x, y, z (float, or double when the origin is not zero)
/// and intensity where there is one. `comment` goes into the header. Throws IoError.
PALOC_EXPORT void savePly(const std::filesystem::path& file, const PointCloud& cloud,
                          const std::string& comment = {});

}  // namespace paloc
