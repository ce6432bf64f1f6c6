#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace paloc {

/// A file open for reading at any place, of known size, on disk or unpacked in memory. Every error
/// is an IoError that names it.
class InputFile {
 public:
  /// Bytes in memory: pieces of kPieceBytes, the last one shorter.
  using Pieces = std::vector<std::vector<std::byte>>;
  static constexpr std::size_t kPieceBytes = 8 << 20;

  /// Throws IoError unless `path` is a regular file that can be opened.
  explicit InputFile(const std::filesystem::path& path);
  /// What was unpacked from the file `name`.
  InputFile(std::string name, Pieces content);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }

  /// Reads exactly `bytes` bytes from `offset`; throws IoError if they are not all there.
  void readAt(std::uint64_t offset, void* out, std::size_t bytes) const;

  /// Throws IoError: "NAME: SENTENCE".
  [[noreturn]] void fail(const std::string& sentence) const;

 private:
  std::size_t readSome(std::uint64_t offset, void* out, std::size_t bytes) const;

  std::string name_;
  int descriptor_ = -1;
  Pieces content_;  ///< if there is no descriptor
  std::uint64_t size_ = 0;
};

}  // namespace paloc
