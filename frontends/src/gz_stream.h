#pragma once

#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <filesystem>
#include <string>

namespace paloc {

/// An archive that MRPT reads objects from: a file, gzipped or not. Unlike MRPT's own stream it
/// tells a clean end from damage, costs nothing extra on an uncompressed file, and knows how far in
/// the file it is. A read gives all that was asked for or nothing: MRPT takes part of a block for
/// the whole.
class GzReadArchive : public mrpt::serialization::CArchive {
 public:
  /// Throws IoError if the file cannot be opened.
  explicit GzReadArchive(const std::filesystem::path& file);
  ~GzReadArchive() override;
  GzReadArchive(const GzReadArchive&) = delete;
  GzReadArchive& operator=(const GzReadArchive&) = delete;

  /// Whether the next read would find nothing, for whatever reason.
  bool atEnd();
  /// What zlib found wrong so far, one phrase; empty if nothing.
  std::string damage() const;
  double progress() const;  ///< 0..1, of the file's bytes

 private:
  std::size_t write(const void* data, std::size_t bytes) override;
  std::size_t read(void* out, std::size_t bytes) override;

  gzFile file_ = nullptr;
  std::uint64_t file_bytes_ = 0;
};

}  // namespace paloc
