#include "gzip_file.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>

#include "paloc/core/text.h"

namespace paloc {
namespace {

constexpr std::size_t kReadBytes = 1 << 18;
constexpr int kGzipOnly = 16 + MAX_WBITS;

class Unpacker {
 public:
  Unpacker(const InputFile& packed, const MemoryBudget& budget)
      : packed_(packed), budget_(budget), in_(kReadBytes) {
    if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~Unpacker() { inflateEnd(&stream_); }
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  InputFile::Pieces run() {
    for (;;) {
      if (stream_.avail_out == 0) newPiece();
      const bool fed = stream_.avail_in > 0 || fill();
      const int status = inflate(&stream_, Z_NO_FLUSH);
      if (status == Z_STREAM_END) {
        if (!nextMember()) break;
      } else if (status == Z_BUF_ERROR && !fed) {
        packed_.fail(text("its gzip data is cut off at byte ", offset_));
      } else if (status != Z_OK && status != Z_BUF_ERROR) {
        packed_.fail(text("its gzip data is damaged near byte ", offset_ - stream_.avail_in));
      }
    }
    pieces_.back().resize(InputFile::kPieceBytes - stream_.avail_out);
    if (pieces_.front().empty()) packed_.fail("its gzip data holds nothing");
    return std::move(pieces_);
  }

 private:
  bool fill() {
    const std::uint64_t left = packed_.size() - offset_;
    if (left == 0) return false;
    const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(left, in_.size()));
    packed_.readAt(offset_, in_.data(), bytes);
    offset_ += bytes;
    stream_.next_in = in_.data();
    stream_.avail_in = static_cast<uInt>(bytes);
    return true;
  }

  // False at the end of the file; zeros that pad it are no member.
  bool nextMember() {
    while (stream_.avail_in > 0 || fill()) {
      while (stream_.avail_in > 0 && *stream_.next_in == 0) ++stream_.next_in, --stream_.avail_in;
      if (stream_.avail_in > 0) {
        inflateReset(&stream_);
        return true;
      }
    }
    return false;
  }

  void newPiece() {
    budget_.require((pieces_.size() + 1) * InputFile::kPieceBytes,
                    text(packed_.name(), ": its unpacked content"));
    pieces_.emplace_back(InputFile::kPieceBytes);
    stream_.next_out = reinterpret_cast<Bytef*>(pieces_.back().data());
    stream_.avail_out = static_cast<uInt>(InputFile::kPieceBytes);
  }

  const InputFile& packed_;
  const MemoryBudget& budget_;
  std::vector<Bytef> in_;
  std::uint64_t offset_ = 0;  // in the packed file, of what is read next
  z_stream stream_{};
  InputFile::Pieces pieces_;
};

}  // namespace

bool isGzip(const InputFile& file) {
  std::array<unsigned char, 2> start{};
  if (file.size() < start.size()) return false;
  file.readAt(0, start.data(), start.size());
  return start[0] == 0x1f && start[1] == 0x8b;
}

InputFile unpackGzip(const InputFile& packed, const MemoryBudget& budget) {
  return {packed.name(), Unpacker(packed, budget).run()};
}

}  // namespace paloc
