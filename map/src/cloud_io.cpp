#include "paloc/map/cloud_io.h"

#include <algorithm>
#include <cctype>

#include "cloud_readers.h"
#include "input_file.h"

namespace paloc {
namespace {

std::string lowerExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

PointCloud loadCloud(const std::filesystem::path& path) {
  const InputFile file(path);
  if (file.size() == 0) file.fail("is empty");
  std::string start(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 16)), '\0');
  file.readAt(0, start.data(), start.size());
  const std::string extension = lowerExtension(path);
  if (start.starts_with("ply\n") || start.starts_with("ply\r")) return readPly(file);
  if (start.starts_with("# .PCD") || start.starts_with("VERSION") || extension == ".pcd") {
    return readPcd(file);
  }
  if (start.starts_with("\x1f\x8b")) file.fail("is gzipped: unpack it first");
  if (extension == ".ply") file.fail("does not begin with 'ply' as a PLY file does");
  if (extension == ".bin") return readKittiBin(file);
  file.fail("is no point cloud in a format that is known (PLY, PCD, or KITTI's .bin)");
}

}  // namespace paloc
