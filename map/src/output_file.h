#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "paloc/core/errors.h"

namespace paloc {

/// A file being written from its start; whatever goes wrong is an IoError that names it.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path) : name_(path.string()) {
    file_.reset(std::fopen(path.c_str(), "wb"));
    if (!file_) fail();
  }
  /// Writes bytes.
  void write(const std::string& bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail();
  }
  /// Ends the file: what could not be written is told here at the latest.
  void close() {
    if (std::fclose(file_.release()) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw IoError(name_ + ": cannot be written: " + std::generic_category().message(errno));
  }
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string name_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// Appends the bytes of a number as it stands in memory (little-endian).
template <typename T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace paloc
