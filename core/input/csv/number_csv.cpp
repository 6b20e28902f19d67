#include "core/input/csv/number_csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/input/csv/delimited_text.hpp"
#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

/// The index of `column` in the heading.
std::size_t index_of(const std::string& column, const DelimitedText& table,
                     const std::string& name) {
  const std::size_t count = table.rows() > 0 ? table.cells(0) : 0;
  std::optional<std::size_t> index;
  std::string heading;
  for (std::size_t k = 0; k < count; ++k) {
    const std::string_view cell = table.cell(0, k);
    heading += fmt::format("{}{}", k > 0 ? ", " : "", cell);
    if (cell != column) continue;
    if (index) throw_input_error(fmt::format("{}: two columns {}", name, column));
    index = k;
  }
  if (!index) {
    throw_input_error(fmt::format("{}: no column {} among the {} that {} separate: {}", name,
                                  column, count, table.separator_name(), shortened(heading)));
  }
  return *index;
}

}  // namespace

void read_number_csv(const std::string& text, const std::string& name,
                     const std::array<std::string, number_columns>& columns, const RowTaker& take) {
  const DelimitedText table(text);
  std::array<std::size_t, number_columns> index;
  for (std::size_t i = 0; i < columns.size(); ++i) index[i] = index_of(columns[i], table, name);
  for (std::size_t row = 1; row < table.rows(); ++row) {
    const auto fail = [&](const std::string& why) {
      throw_input_error(fmt::format("{}:{}: {}", name, table.line(row), why));
    };
    if (table.cells(row) != table.cells(0)) {
      fail(fmt::format("{} separate {} cells, but {} in the heading", table.separator_name(),
                       table.cells(row), table.cells(0)));
    }
    std::array<double, number_columns> numbers;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::optional<double> value = table.number(row, index[i]);
      if (!value || std::isnan(*value)) {
        fail(fmt::format("{} = {}: must be a number", columns[i],
                         shortened(std::string(table.cell(row, index[i])))));
      }
      numbers[i] = *value;
    }
    if (const std::string why = take(numbers); !why.empty()) fail(why);
  }
}

}  // namespace hagfish
