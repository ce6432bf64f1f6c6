#pragma once

#include <tbb/task_arena.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "paloc/core/types.h"
#include "paloc/map/map_settings.h"
#include "plane_store.h"
#include "point_index.h"

namespace paloc {

/// What is costly to make of a map file.
struct PreparedMap {
  Vec3 origin = Vec3::Zero();  // of the local frame (m)
  std::uint64_t points_read = 0, nonfinite = 0, planar = 0;
  std::uint64_t points = 0;
  RawArray<PointBlock> blocks;  // along the curve
  PlaneStore planes;
};

/// The prepared map on disk: the file `MAP.paloc` beside the map file. It holds a hash of the map
/// file's content, the settings and a version of its own, and a hash of all it holds: what does not
/// agree is not used. In the byte order of the machine; a foreign one is made anew.
class MapSideFile {
 public:
  /// Reads the map file once, for its hash. Throws IoError if that cannot be read.
  MapSideFile(const std::filesystem::path& map_file, const MapSettings& settings,
              tbb::task_arena& arena);

  /// The prepared map, if there is one that fits. Never throws for what is wrong with the side
  /// file: problem() tells.
  std::optional<PreparedMap> read();

  /// Replaces the side file, at once or not at all. False, with problem(), if it cannot.
  bool write(const PreparedMap& map);

  /// Why there was nothing to read, or why it could not be written; empty if there is no side file
  /// yet.
  const std::string& problem() const { return problem_; }

  /// Where it lies.
  static std::filesystem::path pathFor(const std::filesystem::path& map_file);

 private:
  struct Header;
  Header headerFor(const PreparedMap& map) const;
  std::string whyUnfit(const Header& header, std::uint64_t file_size) const;

  std::filesystem::path path_;
  MapSettings settings_;
  tbb::task_arena& arena_;
  std::uint64_t map_bytes_ = 0, map_hash_ = 0;
  unsigned mode_ = 0;
  std::string problem_;
};

}  // namespace paloc
