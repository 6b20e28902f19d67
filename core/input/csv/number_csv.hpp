// Tables of numbers as CSV: columns found by their names, a row of finite numbers a line. Lines
// that begin with # are comments, and empty ones do not count. Separators, decimal commas and
// encodings: delimited_text.hpp.
#pragma once

#include <array>
#include <functional>
#include <string>

namespace hagfish {

inline constexpr std::size_t number_columns = 5;

/// Takes the numbers of one row, in the order of the columns asked for. Returns why they cannot
/// follow the rows so far; empty where they can.
using RowTaker = std::function<std::string(const std::array<double, number_columns>& row)>;

/// Gives each row of `text` to `take`; `name` stands for its file in errors. Other columns are left
/// out. Throws InputError, one line, for a column that is missing or there twice, a row with more
/// or less cells than the heading, what is no finite number, and what `take` objects to.
void read_number_csv(const std::string& text, const std::string& name,
                     const std::array<std::string, number_columns>& columns, const RowTaker& take);

}  // namespace hagfish
