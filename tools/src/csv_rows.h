#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "paloc/core/time.h"

namespace paloc {

/// Reads a file of comma-separated values row by row, its columns found by the names in its first
/// line. Throws IoError (file, line, column) on whatever is not as it should be.
class CsvRows {
 public:
  /// Opens the file and finds the `columns`, which must all be there, once.
  CsvRows(const std::filesystem::path& file, std::vector<std::string> columns);

  /// Steps to the next row that is not blank; false at the end.
  bool next();

  // Of the column at `index` in the constructor's list, in this row.
  std::string_view text(std::size_t index) const { return cells_[places_[index]]; }
  double number(std::size_t index) const;  ///< also nan or inf
  TimeNs time(std::size_t index) const;    ///< of decimal seconds, exact

  /// Names of the columns that nobody asked for, in the order of the file.
  const std::vector<std::string>& others() const { return others_; }

  [[noreturn]] void fail(const std::string& sentence) const;

 private:
  void readHeader();

  std::string name_;
  std::ifstream in_;
  std::vector<std::string> columns_, others_;
  std::vector<std::size_t> places_;
  std::string line_;
  std::vector<std::string_view> cells_;  // of line_
  std::uint64_t number_ = 0;
  std::size_t width_ = 0;
};

}  // namespace paloc
