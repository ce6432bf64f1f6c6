#include "input_file.h"
#include "paloc/core/text.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "paloc/core/errors.h"

namespace paloc {

InputFile::InputFile(const std::filesystem::path& path) : name_(path.string()) {
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) fail(text("cannot be opened: ", std::generic_category().message(errno)));
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    descriptor_ = -1;
    fail(S_ISDIR(status.st_mode) ? "is a folder, not a point cloud" : "is not a regular file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::InputFile(std::string name, Pieces content)
    : name_(std::move(name)), content_(std::move(content)) {
  for (const auto& piece : content_) size_ += piece.size();
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void InputFile::readAt(std::uint64_t offset, void* out, std::size_t bytes) const {
  auto* to = static_cast<std::byte*>(out);
  while (bytes > 0) {
    const std::size_t got = readSome(offset, to, bytes);
    if (got == 0) fail(text("ends at byte ", offset, ", where more was expected"));
    to += got;
    offset += got;
    bytes -= got;
  }
}

// At least one byte, or 0 at the end.
std::size_t InputFile::readSome(std::uint64_t offset, void* out, std::size_t bytes) const {
  if (descriptor_ < 0) {
    if (offset >= size_) return 0;
    const auto& piece = content_[static_cast<std::size_t>(offset / kPieceBytes)];
    const auto at = static_cast<std::size_t>(offset % kPieceBytes);
    const std::size_t there = std::min(bytes, piece.size() - at);
    std::memcpy(out, piece.data() + at, there);
    return there;
  }
  ssize_t got = 0;
  do {
    got = ::pread(descriptor_, out, bytes, static_cast<off_t>(offset));
  } while (got < 0 && errno == EINTR);
  if (got < 0) fail(text("cannot be read: ", std::generic_category().message(errno)));
  return static_cast<std::size_t>(got);
}

void InputFile::fail(const std::string& sentence) const { throw IoError(name_ + ": " + sentence); }

}  // namespace paloc
