// Tables as programs of any country write them: cells between commas, semicolons or tabs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hagfish {

class DelimitedText {
 public:
  /// `text` is kept: in UTF-8, or in UTF-16 behind its byte order mark. Lines end with \n, \r\n or
  /// \r; empty ones and those that begin with # do not count. The separator is a semicolon where
  /// the first line has one, else a tab, else a comma. Cells lose the quotes and blanks around
  /// them.
  explicit DelimitedText(std::string text);

  std::size_t rows() const { return first_.size(); }
  std::size_t cells(std::size_t row) const;
  /// Empty behind a row's end.
  std::string_view cell(std::size_t row, std::size_t column) const;
  std::size_t line(std::size_t row) const { return line_[row]; }  ///< line in the file, from 1
  char separator() const { return separator_; }
  /// Words for the separator: "commas", "semicolons" or "tabs".
  const char* separator_name() const;

  /// The number in a cell, with a decimal comma where these do not separate; NaN where it is
  /// missing: empty, a dash, or NaN, NA, n/a, null, none in any case. Nothing where it is anything
  /// else.
  std::optional<double> number(std::size_t row, std::size_t column) const;

 private:
  struct Cell {
    std::size_t begin = 0, size = 0;  ///< in text_: a view would not outlive a move of the table
  };
  std::string text_;
  char separator_ = ',';
  std::vector<Cell> cell_;
  std::vector<std::size_t> first_, line_;  // first cell and line of each row
};

}  // namespace hagfish
