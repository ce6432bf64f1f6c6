#include "paloc/core/text.h"
#include "paloc/map/cloud_io.h"
#include "record_writer.h"

namespace paloc {
namespace {

std::string header(const PointCloud& cloud, const std::string& comment, bool far) {
  std::string lines = "ply\nformat binary_little_endian 1.0\n";
  for (std::size_t at = 0; at < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', at), comment.size());
    lines += text("comment ", comment.substr(at, end - at), '\n');
    at = end + 1;
  }
  lines += text("element vertex ", cloud.size(), '\n');
  for (const char* axis : {"x", "y", "z"}) {
    lines += text("property ", far ? "double " : "float ", axis, '\n');
  }
  if (!cloud.intensity.empty()) lines += "property float intensity\n";
  return lines + "end_header\n";
}

}  // namespace

void savePly(const std::filesystem::path& path, const PointCloud& cloud,
             const std::string& comment) {
  const bool far = !cloud.origin.isZero(0);
  OutputFile file(path);
  file.write(header(cloud, comment, far));
  writeRecords(file, cloud, far);
  file.close();
}

}  // namespace paloc
