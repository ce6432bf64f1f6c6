#include "text_rows.h"
#include "paloc/core/text.h"

#include <algorithm>
#include <charconv>

namespace paloc {
namespace {

constexpr std::size_t kBlockBytes = 1 << 20;  // also the longest line that is believed

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

TextLines::TextLines(const InputFile& file, std::uint64_t offset, std::uint64_t first_line)
    : file_(file), block_offset_(offset), line_number_(first_line - 1) {}

// Moves what is left to the front of the block and reads more behind it. False at the end.
bool TextLines::refill() {
  block_.erase(0, cursor_);
  block_offset_ += cursor_;
  cursor_ = 0;
  const std::size_t kept = block_.size();
  const std::uint64_t left = file_.size() - std::min(file_.size(), block_offset_ + kept);
  if (left == 0) return false;
  if (kept >= kBlockBytes) {
    file_.fail(text("line ", line_number_ + 1, " is longer than ", kBlockBytes, " bytes"));
  }
  const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(left, kBlockBytes));
  block_.resize(kept + more);
  file_.readAt(block_offset_ + kept, block_.data() + kept, more);
  return true;
}

bool TextLines::next(std::string_view& line) {
  std::size_t end = block_.find('\n', cursor_);
  while (end == std::string::npos) {
    if (!refill()) {
      if (cursor_ == block_.size()) return false;
      end = block_.size();  // the last line, without an end
      break;
    }
    end = block_.find('\n', cursor_);
  }
  line = std::string_view(block_).substr(cursor_, end - cursor_);
  while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  cursor_ = std::min(end + 1, block_.size());
  ++line_number_;
  return true;
}

std::string_view nextWord(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && isBlank(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !isBlank(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> result;
  for (auto word = nextWord(line); !word.empty(); word = nextWord(line)) result.push_back(word);
  return result;
}

bool parseNumber(std::string_view word, double& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  return error == std::errc{} && stop == end;
}

bool parseCount(std::string_view word, std::uint64_t& value) {
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  return error == std::errc{} && stop == end;
}

}  // namespace paloc
