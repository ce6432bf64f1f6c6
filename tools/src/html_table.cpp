#include "paloc/tools/html_table.h"

#include <utility>

#include "paloc/tools/html_text.h"

namespace paloc {
namespace {

std::string cssOf(HtmlTable::Align align) {
  return align == HtmlTable::Align::kNumber ? " class=\"number\"" : "";
}

}  // namespace

HtmlTable::HtmlTable(std::string caption, std::vector<ColumnHead> columns)
    : caption_(std::move(caption)), columns_(std::move(columns)) {}

void HtmlTable::addRow(const std::vector<std::string>& cells_html) {
  rows_ += "<tr>";
  for (std::size_t i = 0; i < cells_html.size(); ++i) {
    const std::string css = cssOf(i < columns_.size() ? columns_[i].align : Align::kText);
    rows_ += i == 0 ? "<th scope=\"row\"" + css + '>' + cells_html[i] + "</th>"
                    : "<td" + css + '>' + cells_html[i] + "</td>";
  }
  rows_ += "</tr>\n";
}

std::string HtmlTable::html() const {
  std::string head;
  for (const ColumnHead& column : columns_) {
    head += "<th scope=\"col\"" + cssOf(column.align) + '>' + escapeHtml(column.text) + "</th>";
  }
  const std::string label = escapeHtml(caption_);
  return "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"" + label +
         "\"><table><caption>" + label + "</caption>\n<thead><tr>" + head +
         "</tr></thead>\n<tbody>\n" + rows_ + "</tbody></table></div>\n";
}

}  // namespace paloc
