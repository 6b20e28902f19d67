// Tables of numbers as CSV: columns found by their names, a row of finite numbers a line. Lines
// that begin with # are comments, and empty ones do not count.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>

namespace hagfish {

/// Takes the numbers of one row, in the order of the columns asked for. Returns why they cannot
/// follow the rows so far; empty where they can.
template <std::size_t N>
using RowTaker = std::function<std::string(const std::array<double, N>& row)>;

/// Gives each row of `text` to `take`; `name` stands for its file in errors. Other columns are left
/// out. Throws InputError, one line, for a column that is missing, what is no finite number, and
/// what `take` objects to. N: 4 or 5.
template <std::size_t N>
void read_number_csv(const std::string& text, const std::string& name,
                     const std::array<std::string, N>& columns, const RowTaker<N>& take);

}  // namespace hagfish
