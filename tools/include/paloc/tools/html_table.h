#pragma once

#include <string>
#include <vector>

namespace paloc {

/// A table whose cells are given as HTML: escape what is text. Can be scrolled by keyboard where it
/// is wider than the window.
class HtmlTable {
 public:
  enum class Align { kText, kNumber };
  struct ColumnHead {
    std::string text;  ///< plain
    Align align = Align::kText;
  };

  HtmlTable(std::string caption, std::vector<ColumnHead> columns);

  /// The first cell heads the row.
  void addRow(const std::vector<std::string>& cells_html);
  std::string html() const;

 private:
  std::string caption_;
  std::vector<ColumnHead> columns_;
  std::string rows_;
};

}  // namespace paloc
