#pragma once

#include <filesystem>

namespace paloc {

/// The folder that a result is written to. Nothing of the user's is ever deleted: files are only
/// replaced, by name, and only when asked.
class ResultFolder {
 public:
  /// Makes the folder. Throws UsageError if there is something in it already and `overwrite` is not
  /// set, IoError if it cannot be made or written to.
  ResultFolder(const std::filesystem::path& folder, bool overwrite);

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path file(const char* name) const { return folder_ / name; }

 private:
  std::filesystem::path folder_;
};

/// Throws UsageError if a file is there already and `overwrite` is not set.
void checkNotThere(const std::filesystem::path& file, bool overwrite);

/// Writes a whole text file. Throws IoError if it cannot be written completely.
void writeTextFile(const std::filesystem::path& file, const std::string& content);

}  // namespace paloc
