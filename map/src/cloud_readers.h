#pragma once

#include "input_file.h"
#include "paloc/map/cloud_io.h"

namespace paloc {

// One reader a format; loadCloud chooses. Each throws IoError as loadCloud does.
PointCloud readPly(const InputFile& file, const LoadOptions& options);
PointCloud readPcd(const InputFile& file, const LoadOptions& options);
PointCloud readKittiBin(const InputFile& file, const LoadOptions& options);
PointCloud readLas(const InputFile& file, const LoadOptions& options);
PointCloud readXyz(const InputFile& file, const LoadOptions& options);
PointCloud readOctree(const InputFile& file, const LoadOptions& options);

/// Chooses the reader for a file, which may be gzipped, by its first bytes and its ending.
PointCloud readCloud(const InputFile& file, const LoadOptions& options);

}  // namespace paloc
