// Tables on standard output.
#pragma once

#include <string>
#include <vector>

namespace lodestone::app {

/// Columns padded to their widest cell, two spaces between.
class Table {
 public:
  enum class Align { left, right };
  void add_column(std::string title, Align align = Align::right);
  /// One cell a column.
  void add_row(std::vector<std::string> cells);
  /// With a title line unless all titles are empty; every line ends with a newline, none with spaces.
  std::string text() const;

 private:
  struct Column {
    std::string title;
    Align align;
  };
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace lodestone::app
