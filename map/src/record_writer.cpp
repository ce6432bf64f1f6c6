#include "record_writer.h"

namespace paloc {

void writeRecords(OutputFile& file, const PointCloud& cloud, bool far) {
  constexpr std::size_t kBlockBytes = 1 << 20;
  std::string bytes;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Point3f& p = cloud.points[i];
    if (far) {
      append(bytes, cloud.origin.x() + static_cast<double>(p.x));
      append(bytes, cloud.origin.y() + static_cast<double>(p.y));
      append(bytes, cloud.origin.z() + static_cast<double>(p.z));
    } else {
      append(bytes, p.x);
      append(bytes, p.y);
      append(bytes, p.z);
    }
    if (!cloud.intensity.empty()) append(bytes, cloud.intensity[i]);
    if (bytes.size() >= kBlockBytes) {
      file.write(bytes);
      bytes.clear();
    }
  }
  file.write(bytes);
}

}  // namespace paloc
