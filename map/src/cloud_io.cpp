#include "paloc/map/cloud_io.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "cloud_readers.h"
#include "gzip_file.h"
#include "memory_budget.h"
#include "paloc/core/text.h"

namespace paloc {
namespace {

constexpr std::array<std::string_view, 9> kTextEndings{".xyz",  ".txt",    ".asc", ".csv", ".pts",
                                                       ".xyzi", ".xyzrgb", ".neu", ".xyzn"};

// The ending in small letters, of what is in it where the file is gzipped: ".ply" of "a.PLY.gz".
std::string endingOf(const InputFile& file) {
  std::filesystem::path path(file.name());
  const auto lower = [&path] {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
  };
  std::string ending = lower();
  if (ending != ".gz") return ending;
  path.replace_extension();
  return lower();
}

PointCloud readPlain(const InputFile& file, const LoadOptions& options) {
  std::string start(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 16)), '\0');
  file.readAt(0, start.data(), start.size());
  const std::string ending = endingOf(file);
  if (start.starts_with("ply\n") || start.starts_with("ply\r")) return readPly(file, options);
  if (start.starts_with("# .PCD") || start.starts_with("VERSION") || ending == ".pcd") {
    return readPcd(file, options);
  }
  if (start.starts_with("LASF")) return readLas(file, options);
  if (start.starts_with("# Octomap OcTree")) return readOctree(file, options);
  if (ending == ".ply") file.fail("does not begin with 'ply' as a PLY file does");
  if (ending == ".las" || ending == ".laz") {
    file.fail("does not begin with 'LASF' as a LAS file does");
  }
  if (ending == ".bt" || ending == ".ot") {
    file.fail("does not begin with '# Octomap OcTree' as OctoMap's files do");
  }
  if (ending == ".bin") return readKittiBin(file, options);
  if (std::find(kTextEndings.begin(), kTextEndings.end(), ending) != kTextEndings.end()) {
    return readXyz(file, options);
  }
  file.fail(
      "is no point cloud in a format that is known (PLY, PCD, LAS, XYZ text, OctoMap, KITTI's "
      ".bin; gzipped or not)");
}

}  // namespace

PointCloud readCloud(const InputFile& file, const LoadOptions& options) {
  if (file.size() == 0) file.fail("is empty");
  if (!isGzip(file)) return readPlain(file, options);
  const InputFile unpacked = unpackGzip(file, MemoryBudget(options.memory_limit_bytes));
  if (isGzip(unpacked)) file.fail("is gzipped twice: unpack it first");
  PointCloud cloud = readPlain(unpacked, options);
  cloud.format += ", gzipped";
  return cloud;
}

PointCloud loadCloud(const std::filesystem::path& path, const LoadOptions& options) {
  return readCloud(InputFile(path), options);
}

}  // namespace paloc
