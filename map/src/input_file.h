#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace paloc {

/// A file open for reading at any place, of known size. Every error is an IoError that names it.
class InputFile {
 public:
  /// Throws IoError unless `path` is a regular file that can be opened.
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }

  /// Reads exactly `bytes` bytes from `offset`; throws IoError if they are not all there.
  void readAt(std::uint64_t offset, void* out, std::size_t bytes) const;

  /// Throws IoError: the file's name, a colon, the sentence.
  [[noreturn]] void fail(const std::string& sentence) const;

 private:
  std::string name_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace paloc
