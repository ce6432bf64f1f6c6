#pragma once

#include "output_file.h"
#include "paloc/map/cloud_io.h"

namespace paloc {

/// Writes a cloud's points as records of x, y, z (float, or double with the origin added where it
/// is `far` from zero) and intensity, if there is one: what PLY and PCD files hold.
void writeRecords(OutputFile& file, const PointCloud& cloud, bool far);

}  // namespace paloc
