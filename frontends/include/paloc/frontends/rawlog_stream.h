#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "paloc/core/export.h"

namespace paloc {

/// Reads the observations of a rawlog one by one, in both of MRPT's formats (observations only, or
/// actions and sensory frames), gzipped or not, without loading it whole.
class PALOC_EXPORT RawlogStream {
 public:
  enum class End {
    kNone,     ///< there may be more
    kClean,    ///< the file ended between two objects
    kDamaged,  ///< it did not: what came before is good, error() says what happened
  };

  /// Throws IoError if the file does not exist or cannot be opened.
  explicit RawlogStream(const std::filesystem::path& file);
  ~RawlogStream();
  RawlogStream(const RawlogStream&) = delete;
  RawlogStream& operator=(const RawlogStream&) = delete;

  /// The next observation, or null at the end: see end(). Comments and actions are passed over.
  mrpt::obs::CObservation::Ptr next();

  End end() const;
  const std::string& error() const;  ///< one sentence; empty unless damaged
  std::uint64_t objectsRead() const;
  /// Share of the file's bytes read so far, 0..1.
  double progress() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes observations to a rawlog. Uncompressed unless asked: gzip costs 40 ms a scan.
class PALOC_EXPORT RawlogWriter {
 public:
  enum class Compression { kNone, kGzip };

  /// Throws IoError if the file cannot be created.
  explicit RawlogWriter(const std::filesystem::path& file,
                        Compression compression = Compression::kNone);
  ~RawlogWriter();
  RawlogWriter(const RawlogWriter&) = delete;
  RawlogWriter& operator=(const RawlogWriter&) = delete;

  /// Throws IoError when the disk is full.
  void write(const mrpt::obs::CObservation& observation);
  /// Closes and checks that all bytes arrived. Throws IoError if not. MRPT's own close says
  /// nothing.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace paloc
