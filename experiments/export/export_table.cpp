#include "experiments/export/export_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

/// The unit in words for the dictionary: "dyn_cm" is dyn cm, "rad_per_cm" is rad/cm.
std::string in_words(std::string unit) {
  if (const std::size_t at = unit.find("_per_"); at != std::string::npos) {
    unit.replace(at, 5, "/");
  }
  std::ranges::replace(unit, '_', ' ');
  return unit.empty() ? "1" : unit;
}

}  // namespace

ExportTable::ExportTable(std::string name, std::vector<ExportColumn> columns, bool si)
    : name_(std::move(name)), columns_(std::move(columns)), si_(si), rows_(1) {
  for (const ExportColumn& column : columns_) {
    const std::string unit = si_ ? column.unit.si : column.unit.cgs;
    rows_[0].push_back(unit.empty() ? column.name : column.name + "_" + unit);
  }
}

void ExportTable::add(const std::vector<Cell>& cells) {
  if (cells.size() != columns_.size()) {
    throw std::invalid_argument(name_ + ": a row does not have a cell for each column");
  }
  std::vector<std::string>& row = rows_.emplace_back();
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (const auto* number = std::get_if<double>(&cells[k])) {
      const double value = *number * (si_ ? columns_[k].unit.si_per_cgs : 1);
      // Nine digits: 1e-8 cm of a length, and half the bytes of all seventeen. Adding 0 makes a
      // plain 0 of -0.
      row.push_back(std::isfinite(value) ? fmt::format("{:.9g}", value + 0.0) : "");
    } else if (const auto* count = std::get_if<std::int64_t>(&cells[k])) {
      row.push_back(std::to_string(*count));
    } else {
      row.push_back(printable(std::get<std::string>(cells[k])));
    }
  }
}

void ExportTable::describe(CsvTable& dictionary) const {
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const FigureUnit& unit = columns_[k].unit;
    dictionary.push_back(
        {name_, rows_[0][k], in_words(si_ ? unit.si : unit.cgs), columns_[k].meaning});
  }
}

}  // namespace hagfish
