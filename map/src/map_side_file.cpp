#include "map_side_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <span>
#include <system_error>
#include <vector>

#include "content_hash.h"
#include "input_file.h"
#include "paloc/core/errors.h"
#include "parallel_chunks.h"

namespace paloc {
namespace {

// To be raised whenever the same map would be prepared in another way.
constexpr std::uint64_t kVersion = 3;
constexpr std::uint64_t kByteOrder = 0x0102030405060708ULL;
constexpr char kMagic[16] = "paloc side file";

/// A file under another name until it is whole. Removed unless it was put in its place.
class NewFile {
 public:
  NewFile(const std::filesystem::path& path, mode_t mode)
      : path_(path), name_(path.string() + ".XXXXXX"), descriptor_(mkstemp(name_.data())) {
    note(descriptor_ >= 0 && fchmod(descriptor_, mode) == 0);
  }
  ~NewFile() {
    if (descriptor_ < 0) return;
    close(descriptor_);
    if (!placed_) unlink(name_.c_str());
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(const void* bytes, std::size_t size) {
    const auto* at = static_cast<const char*>(bytes);
    while (error_ == 0 && size > 0) {
      const ssize_t done = ::write(descriptor_, at, std::min<std::size_t>(size, 1U << 30));
      if (done < 0 && errno == EINTR) continue;
      note(done >= 0);
      if (done < 0) return;
      at += done;
      size -= static_cast<std::size_t>(done);
    }
  }
  bool place() {
    if (error_ == 0) note(placed_ = rename(name_.c_str(), path_.c_str()) == 0);
    return placed_;
  }
  std::string trouble() const { return std::generic_category().message(error_); }

 private:
  void note(bool good) {
    if (!good && error_ == 0) error_ = errno;
  }

  std::filesystem::path path_;
  std::string name_;
  int descriptor_, error_ = 0;
  bool placed_ = false;
};

/// The two parts of a prepared map that take the room.
template <typename Byte>
using Parts = std::array<std::span<Byte>, 2>;

Parts<const std::byte> bytesOf(const PreparedMap& map) {
  return {std::as_bytes(std::span(map.blocks.data(), map.blocks.size())),
          std::as_bytes(std::span(map.planes.data(), map.planes.size()))};
}

Parts<std::byte> writableBytesOf(PreparedMap& map) {
  return {std::as_writable_bytes(std::span(map.blocks.data(), map.blocks.size())),
          std::as_writable_bytes(std::span(map.planes.data(), map.planes.size()))};
}

// Hash of the parts, chunk by chunk; before(bytes, offset) may fill each chunk first.
template <typename Byte, typename Before>
std::uint64_t hashOfParts(const Parts<Byte>& parts, tbb::task_arena& arena, const Before& before) {
  std::vector<std::uint64_t> hashes;
  std::size_t offset = 0;
  for (const std::span<Byte>& part : parts) {
    const std::size_t first = hashes.size();
    hashes.resize(first + chunkCount(part.size(), kHashChunk));
    forEachChunk(arena, part.size(), kHashChunk,
                 [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                   const std::span<Byte> bytes = part.subspan(begin, end - begin);
                   before(bytes, offset + begin);
                   hashes[first + chunk] = hashOf(bytes.data(), bytes.size());
                 });
    offset += part.size();
  }
  return hashOf(hashes.data(), hashes.size() * sizeof(std::uint64_t));
}

}  // namespace

struct MapSideFile::Header {
  char magic[16];
  std::uint64_t byte_order, version;
  std::uint64_t map_bytes, map_hash;
  double voxel_m, plane_max_radius_m, plane_max_thickness_m;
  std::int64_t plane_neighbours;
  double origin[3];
  std::uint64_t points_read, nonfinite, planar, points;
  std::uint64_t payload_hash;
  std::uint64_t header_hash;  // of all before it

  std::uint64_t ownHash() const { return hashOf(this, offsetof(Header, header_hash)); }
  std::uint64_t blocks() const { return chunkCount(points, PointBlock::kPoints); }
  std::uint64_t fileSize() const {
    return sizeof(Header) + blocks() * sizeof(PointBlock) + points * sizeof(PackedPlane);
  }
};

std::filesystem::path MapSideFile::pathFor(const std::filesystem::path& map_file) {
  std::filesystem::path path = map_file;
  path += ".paloc";
  return path;
}

MapSideFile::MapSideFile(const std::filesystem::path& map_file, const MapSettings& settings,
                         tbb::task_arena& arena)
    : path_(pathFor(map_file)), settings_(settings), arena_(arena) {
  const InputFile file(map_file);
  // Who may read the map may read what was made of it.
  mode_ = static_cast<unsigned>(std::filesystem::status(map_file).permissions()) & 0666U;
  map_bytes_ = file.size();
  map_hash_ = hashOfFile(file, arena);
}

MapSideFile::Header MapSideFile::headerFor(const PreparedMap& map) const {
  Header header;
  std::memset(&header, 0, sizeof header);
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.byte_order = kByteOrder;
  header.version = kVersion;
  header.map_bytes = map_bytes_;
  header.map_hash = map_hash_;
  header.voxel_m = settings_.voxel_m;
  header.plane_neighbours = settings_.plane_neighbours;
  header.plane_max_radius_m = settings_.plane_max_radius_m;
  header.plane_max_thickness_m = settings_.plane_max_thickness_m;
  for (int i = 0; i < 3; ++i) header.origin[i] = map.origin[i];
  header.points_read = map.points_read;
  header.nonfinite = map.nonfinite;
  header.planar = map.planar;
  header.points = map.points;
  return header;
}

std::string MapSideFile::whyUnfit(const Header& header, std::uint64_t file_size) const {
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0) return "is no side file of a map";
  if (header.byte_order != kByteOrder || header.version != kVersion) {
    return "is of another version of this program";
  }
  if (header.header_hash != header.ownHash() ||
      header.points >= std::numeric_limits<std::uint32_t>::max() ||
      header.fileSize() != file_size) {
    return "is damaged";
  }
  if (header.map_bytes != map_bytes_ || header.map_hash != map_hash_) {
    return "belongs to another content of the map file";
  }
  if (header.voxel_m != settings_.voxel_m ||
      header.plane_neighbours != settings_.plane_neighbours ||
      header.plane_max_radius_m != settings_.plane_max_radius_m ||
      header.plane_max_thickness_m != settings_.plane_max_thickness_m) {
    return "was made with other settings";
  }
  return {};
}

std::optional<PreparedMap> MapSideFile::read() {
  problem_.clear();
  std::error_code error;
  if (!std::filesystem::exists(path_, error)) return std::nullopt;
  try {
    const InputFile file(path_);
    Header header;
    if (file.size() < sizeof header) file.fail("is damaged");
    file.readAt(0, &header, sizeof header);
    const std::string unfit = whyUnfit(header, file.size());
    if (!unfit.empty()) file.fail(unfit);
    PreparedMap map;
    map.origin = Vec3(header.origin[0], header.origin[1], header.origin[2]);
    map.points_read = header.points_read;
    map.nonfinite = header.nonfinite;
    map.planar = header.planar;
    map.points = header.points;
    map.blocks = RawArray<PointBlock>(header.blocks());
    map.planes = PlaneStore(header.points);
    const std::uint64_t hash = hashOfParts(
        writableBytesOf(map), arena_, [&](std::span<std::byte> bytes, std::size_t offset) {
          file.readAt(sizeof(Header) + offset, bytes.data(), bytes.size());
        });
    if (hash != header.payload_hash) file.fail("is damaged");
    return map;
  } catch (const IoError& unusable) {
    problem_ = unusable.what();
    return std::nullopt;
  }
}

bool MapSideFile::write(const PreparedMap& map) {
  using std::filesystem::perms;
  const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
  std::error_code error;
  const perms may = std::filesystem::status(folder, error).permissions();
  constexpr perms kWrite = perms::owner_write | perms::group_write | perms::others_write;
  if (error || (may & kWrite) == perms::none) {  // root could, but is not meant to
    problem_ = path_.string() + ": cannot be written: the folder is write-protected";
    return false;
  }
  const Parts<const std::byte> parts = bytesOf(map);
  Header header = headerFor(map);
  header.payload_hash = hashOfParts(parts, arena_, [](std::span<const std::byte>, std::size_t) {});
  header.header_hash = header.ownHash();
  NewFile file(path_, mode_);
  file.write(&header, sizeof header);
  for (const auto& part : parts) file.write(part.data(), part.size());
  if (file.place()) return true;
  problem_ = path_.string() + ": cannot be written: " + file.trouble();
  return false;
}

}  // namespace paloc
