#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "input_file.h"

namespace paloc {

/// Reads the lines of a text file, or of the text part of one, in big blocks.
class TextLines {
 public:
  /// From byte `offset`, which is the start of line `first_line` (1 is the first).
  TextLines(const InputFile& file, std::uint64_t offset, std::uint64_t first_line);

  /// The next line without its end, valid until the next call. False at the end of the file.
  bool next(std::string_view& line);
  std::uint64_t lineNumber() const { return line_number_; }         ///< of the line given last
  std::uint64_t offset() const { return block_offset_ + cursor_; }  ///< of the line after it

 private:
  bool refill();

  const InputFile& file_;
  std::string block_;
  std::uint64_t block_offset_ = 0;  ///< in the file, of block_[0]
  std::size_t cursor_ = 0;
  std::uint64_t line_number_ = 0;
};

/// Cuts the next word off `line`; empty at its end. Blanks and tabs separate.
std::string_view nextWord(std::string_view& line);

/// All words of a line.
std::vector<std::string_view> words(std::string_view line);

/// A decimal number, "nan" and "inf" included. False if the whole word is not one.
bool parseNumber(std::string_view word, double& value);

/// A count or size in a header. False if the whole word is not a non-negative integer that fits.
bool parseCount(std::string_view word, std::uint64_t& value);

}  // namespace paloc
