#pragma once

#include <cstdlib>
#include <filesystem>

namespace paloc {

/// Where the data of the workspace lie, which are no part of the project: the environment variable
/// PALOC_SHARED_DATA, or `shared/data` beside the source folder. A test must skip if it is not
/// there.
inline std::filesystem::path sharedData() {
  if (const char* folder = std::getenv("PALOC_SHARED_DATA")) return folder;
  const std::filesystem::path beside =
      std::filesystem::path(PALOC_SOURCE_DIR) / ".." / "shared" / "data";
  return beside.lexically_normal();
}

}  // namespace paloc
