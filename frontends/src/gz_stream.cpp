#include "gz_stream.h"

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "paloc/core/errors.h"

namespace paloc {

GzReadArchive::GzReadArchive(const std::filesystem::path& file) {
  constexpr unsigned kBufferBytes = 1 << 18;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw IoError(file.string() + ": no such file");
  if (std::filesystem::is_directory(file, error)) {
    throw IoError(file.string() + ": is a folder, not a rawlog");
  }
  if (!std::filesystem::is_regular_file(file, error)) {
    throw IoError(file.string() + ": is not a regular file");
  }
  file_bytes_ = std::filesystem::file_size(file, error);
  file_ = ::gzopen(file.c_str(), "rb");
  if (file_ == nullptr) {
    throw IoError(file.string() + ": cannot be opened: " + std::generic_category().message(errno));
  }
  ::gzbuffer(file_, kBufferBytes);
}

GzReadArchive::~GzReadArchive() { ::gzclose_r(file_); }

bool GzReadArchive::atEnd() {
  const int next = gzgetc(file_);  // a macro
  if (next < 0) return true;
  ::gzungetc(next, file_);
  return false;
}

std::string GzReadArchive::damage() const {
  int code = Z_OK;
  const char* message = ::gzerror(file_, &code);
  if (code == Z_OK || code == Z_STREAM_END) return {};
  if (code == Z_BUF_ERROR) return "the gzip stream has no end (recording cut off?)";
  if (code == Z_ERRNO) return "it cannot be read: " + std::generic_category().message(errno);
  return std::string("the gzip stream is damaged") +
         (message != nullptr && *message != '\0' ? std::string(" (") + message + ")" : "");
}

double GzReadArchive::progress() const {
  const auto at = ::gzoffset(file_);
  if (file_bytes_ == 0 || at < 0) return 1;
  return std::min(1.0, static_cast<double>(at) / static_cast<double>(file_bytes_));
}

std::size_t GzReadArchive::write(const void*, std::size_t) {
  throw std::logic_error("this archive is for reading");
}

std::size_t GzReadArchive::read(void* out, std::size_t bytes) {
  auto* to = static_cast<char*>(out);
  std::size_t left = bytes;
  while (left > 0) {
    const auto piece = static_cast<unsigned>(std::min<std::size_t>(left, 1U << 30U));
    const int got = ::gzread(file_, to, piece);
    if (got <= 0) return 0;
    to += got;
    left -= static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace paloc
