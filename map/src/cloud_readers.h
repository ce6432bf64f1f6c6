#pragma once

#include "input_file.h"
#include "paloc/map/point_cloud.h"

namespace paloc {

// One reader a format; loadCloud chooses. Each throws IoError as loadCloud does.
PointCloud readPly(const InputFile& file);
PointCloud readPcd(const InputFile& file);
PointCloud readKittiBin(const InputFile& file);

}  // namespace paloc
