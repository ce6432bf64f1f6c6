#pragma once

#include <filesystem>
#include <string>

#include "paloc/core/export.h"
#include "paloc/map/point_cloud.h"

namespace paloc {

/// Reads a point cloud; the format is told by the file's first bytes, and by its ending for formats
/// without a signature: PLY (ascii, binary_little_endian, binary_big_endian), PCD (ascii, binary,
/// binary_compressed), KITTI .bin (x y z intensity, float32). Non-finite points are left out and
/// counted. Throws IoError with one sentence (file, line or byte, field) for anything else.
PALOC_EXPORT PointCloud loadCloud(const std::filesystem::path& file);

/// Writes a binary little-endian PLY with x, y, z (float, or double when the origin is not zero)
/// and intensity where there is one. `comment` goes into the header. Throws IoError.
PALOC_EXPORT void savePly(const std::filesystem::path& file, const PointCloud& cloud,
                          const std::string& comment = {});

}  // namespace paloc
