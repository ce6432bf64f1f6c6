#pragma once

#include <stdexcept>
#include <string>

#include "paloc/core/export.h"

namespace paloc {

/// The command line is wrong. One sentence that names the option.
class PALOC_EXPORT UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A configuration is wrong. One sentence that names file, line and key.
class PALOC_EXPORT ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file cannot be read or written. One sentence that names the file, and the line or field.
class PALOC_EXPORT IoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace paloc
