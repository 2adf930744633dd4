#include "app/output/table.h"

#include <algorithm>

#include "app/output/text.h"
#include "lodestone/base/check.h"

namespace lodestone::app {

void Table::add_column(std::string title, Align align) { columns_.push_back(Column{std::move(title), align}); }

void Table::add_row(std::vector<std::string> cells) {
  LODESTONE_CHECK(cells.size() == columns_.size(), "one cell a column");
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  std::vector<std::vector<std::string>> lines;
  std::vector<std::string> titles;
  for (const Column& column : columns_) titles.push_back(column.title);
  if (std::any_of(titles.begin(), titles.end(), [](const std::string& t) { return !t.empty(); }))
    lines.push_back(titles);
  lines.insert(lines.end(), rows_.begin(), rows_.end());

  std::vector<std::size_t> widths(columns_.size(), 0);
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], width_of(line[c]));
  }
  std::string out;
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t c = 0; c < line.size(); ++c) {
      const std::string padding(widths[c] - width_of(line[c]), ' ');
      if (c > 0) text += "  ";
      text += columns_[c].align == Align::left ? line[c] + padding : padding + line[c];
    }
    text.erase(text.find_last_not_of(' ') + 1);
    out += text + '\n';
  }
  return out;
}

}  // namespace lodestone::app
