// A tidy table of what a log holds: columns with units in their names, a dictionary of them, CGS or
// SI.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "experiments/program/csv.hpp"

namespace hagfish {

/// What a column's values count, as its name ends.
struct ExportUnit {
  const char* cgs;
  const char* si;
  double si_per_cgs;
};
namespace export_unit {
inline constexpr ExportUnit none{"", "", 1};
inline constexpr ExportUnit second{"s", "s", 1};
inline constexpr ExportUnit radian{"rad", "rad", 1};
inline constexpr ExportUnit centimetre{"cm", "m", 1e-2};
inline constexpr ExportUnit area{"cm2", "m2", 1e-4};
inline constexpr ExportUnit gram{"g", "kg", 1e-3};
inline constexpr ExportUnit per_length{"rad_per_cm", "rad_per_m", 1e2};
inline constexpr ExportUnit speed{"cm_per_s", "m_per_s", 1e-2};
inline constexpr ExportUnit force{"dyn", "N", 1e-5};
inline constexpr ExportUnit torque{"dyn_cm", "N_m", 1e-7};
inline constexpr ExportUnit torque_time{"dyn_cm_s", "N_m_s", 1e-7};
inline constexpr ExportUnit energy{"erg", "J", 1e-7};
}  // namespace export_unit

struct ExportColumn {
  std::string name;  ///< without its unit
  ExportUnit unit;
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
