#include "paloc/tools/result_folder.h"

#include <fstream>

#include "paloc/core/errors.h"

namespace paloc {
namespace {

bool canWriteTo(const std::filesystem::path& folder) {
  const std::filesystem::path probe = folder / ".paloc_write_test";
  const bool good = static_cast<bool>(std::ofstream(probe) << "x" << std::flush);
  std::error_code ignored;
  std::filesystem::remove(probe, ignored);
  return good;
}

}  // namespace

ResultFolder::ResultFolder(const std::filesystem::path& folder, bool overwrite) : folder_(folder) {
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error)) {
    throw UsageError(folder.string() + ": is a file, not a folder to write results to");
  }
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError(folder.string() + ": cannot make this folder: " + error.message());
  if (!overwrite && !std::filesystem::is_empty(folder, error)) {
    throw UsageError(
        folder.string() +
        ": there is something in this folder already; give another one, or --overwrite");
  }
  if (!canWriteTo(folder)) throw IoError(folder.string() + ": cannot write to this folder");
}

void checkNotThere(const std::filesystem::path& file, bool overwrite) {
  std::error_code ignored;
  if (!overwrite && std::filesystem::exists(file, ignored)) {
    throw UsageError(file.string() + ": is there already; give another name, or --overwrite");
  }
}

void writeTextFile(const std::filesystem::path& file, const std::string& content) {
  std::ofstream out(file, std::ios::binary);
  out << content;
  out.close();
  if (!out) throw IoError(file.string() + ": cannot be written completely (is the disk full?)");
}

}  // namespace paloc
