#include "cloud_readers.h"
#include "paloc/core/text.h"
#include "row_reader.h"

namespace paloc {

// KITTI's velodyne files: records of x, y, z (m) and reflectance, float32, and nothing else.
PointCloud readKittiBin(const InputFile& file, const LoadOptions& options) {
  const std::vector<CloudField> fields{{"x"}, {"y"}, {"z"}, {"intensity"}};
  RecordLayout layout;
  layout.record_bytes = 16;
  layout.offsets = {0, 4, 8, 12};
  layout.records = file.size() / layout.record_bytes;
  if (file.size() % layout.record_bytes != 0) {
    file.fail(
        text("its ", file.size(), " bytes are no whole number of KITTI points (16 bytes each)"));
  }
  PointCloud cloud = readRecords(file, fields, layout, options);
  cloud.format = "KITTI .bin";
  return cloud;
}

}  // namespace paloc
