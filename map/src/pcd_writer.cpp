#include "paloc/core/text.h"
#include "paloc/map/cloud_io.h"
#include "record_writer.h"

namespace paloc {
namespace {

std::string header(const PointCloud& cloud, bool far) {
  const std::string coordinate_bytes = far ? " 8" : " 4";
  const bool intensity = !cloud.intensity.empty();
  return text("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z",
              intensity ? " intensity" : "", "\nSIZE", coordinate_bytes, coordinate_bytes,
              coordinate_bytes, intensity ? " 4" : "", "\nTYPE F F F", intensity ? " F" : "",
              "\nCOUNT 1 1 1", intensity ? " 1" : "", "\nWIDTH ", cloud.size(),
              "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS ", cloud.size(), "\nDATA binary\n");
}

}  // namespace

void savePcd(const std::filesystem::path& path, const PointCloud& cloud) {
  const bool far = !cloud.origin.isZero(0);
  OutputFile file(path);
  file.write(header(cloud, far));
  writeRecords(file, cloud, far);
  file.close();
}

}  // namespace paloc
