#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/frontends/rawlog_stream.h"

namespace paloc {
namespace {

// zlib's plain mode ("T") writes through: one archive for both kinds of file.
class GzWriteArchive : public mrpt::serialization::CArchive {
 public:
  GzWriteArchive(const std::filesystem::path& file, bool compress)
      : file_(::gzopen(file.c_str(), compress ? "wb1" : "wbT")) {
    constexpr unsigned kBufferBytes = 1 << 20;
    if (file_ != nullptr) ::gzbuffer(file_, kBufferBytes);
  }
  ~GzWriteArchive() override {
    if (file_ != nullptr) ::gzclose_w(file_);
  }
  GzWriteArchive(const GzWriteArchive&) = delete;
  GzWriteArchive& operator=(const GzWriteArchive&) = delete;

  bool isOpen() const { return file_ != nullptr; }
  std::uint64_t bytes() const { return bytes_; }
  /// False if what was buffered could not be written.
  bool close() { return ::gzclose_w(std::exchange(file_, nullptr)) == Z_OK; }

 private:
  std::size_t read(void*, std::size_t) override {
    throw std::logic_error("this archive is for writing");
  }
  std::size_t write(const void* data, std::size_t bytes) override {
    const auto* from = static_cast<const char*>(data);
    for (std::size_t left = bytes; left > 0;) {
      const auto piece = static_cast<unsigned>(std::min<std::size_t>(left, 1U << 30U));
      const int put = ::gzwrite(file_, from, piece);
      if (put <= 0) return 0;
      from += put;
      left -= static_cast<std::size_t>(put);
    }
    bytes_ += bytes;
    return bytes;
  }

  gzFile file_;
  std::uint64_t bytes_ = 0;
};

// The uncompressed length modulo 2^32, which is the last word of a gzip file.
std::uint32_t gzipTrailer(const std::filesystem::path& file) {
  std::array<unsigned char, 4> last{};
  std::ifstream in(file, std::ios::binary);
  in.seekg(-4, std::ios::end);
  in.read(reinterpret_cast<char*>(last.data()), last.size());
  return in ? last[0] | last[1] << 8U | last[2] << 16U | static_cast<std::uint32_t>(last[3]) << 24U
            : 0;
}

}  // namespace

struct RawlogWriter::Impl {
  Impl(const std::filesystem::path& path, bool with_gzip)
      : file(path), gzip(with_gzip), archive(path, with_gzip) {}

  [[noreturn]] void fail(int error) const {
    throw IoError(text(file.string(), ": cannot be written completely: ",
                       error != 0 ? std::generic_category().message(error) : "bytes are missing"));
  }

  std::filesystem::path file;
  bool gzip;
  GzWriteArchive archive;
};

RawlogWriter::RawlogWriter(const std::filesystem::path& file, Compression compression)
    : impl_(std::make_unique<Impl>(file, compression == Compression::kGzip)) {
  if (!impl_->archive.isOpen()) {
    throw IoError(
        text(file.string(), ": cannot be created: ", std::generic_category().message(errno)));
  }
}

RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::obs::CObservation& observation) {
  errno = 0;
  try {
    impl_->archive << observation;
  } catch (const std::exception&) {  // MRPT's text says no more than that it failed
    impl_->fail(errno);
  }
}

void RawlogWriter::close() {
  if (!impl_->archive.isOpen()) return;
  errno = 0;
  if (!impl_->archive.close()) impl_->fail(errno);
  const std::uint64_t bytes = impl_->archive.bytes();
  std::error_code error;
  const bool arrived = impl_->gzip
                           ? gzipTrailer(impl_->file) == static_cast<std::uint32_t>(bytes)
                           : std::filesystem::file_size(impl_->file, error) == bytes && !error;
  if (!arrived) impl_->fail(0);
}

}  // namespace paloc
