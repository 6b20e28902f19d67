// A tidy table of what a log holds: columns with units in their names, a dictionary of them, CGS or
// SI.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "experiments/common/csv.hpp"
#include "experiments/judge/figure_unit.hpp"

namespace hagfish {

struct ExportColumn {
  std::string name;  ///< without its unit
  FigureUnit unit;
  std::string meaning;
};

class ExportTable {
 public:
  /// One field; numbers in CGS. What is nan stays empty, as spreadsheets, R and pandas read what is
  /// missing.
  using Cell = std::variant<double, std::int64_t, std::string>;

  /// `name` is the file's. `si` converts every number.
  ExportTable(std::string name, std::vector<ExportColumn> columns, bool si);
  /// Appends a row; throws std::invalid_argument unless it has a cell for each column.
  void add(const std::vector<Cell>& cells);
  const std::string& name() const { return name_; }
  std::string csv() const { return csv_text(rows_); }
  /// A row for each column: file, column, unit, meaning.
  void describe(CsvTable& dictionary) const;

 private:
  std::string name_;
  std::vector<ExportColumn> columns_;
  bool si_;
  CsvTable rows_;
};

}  // namespace hagfish
