// Tables as CSV (RFC 4180, lines end with \n).
#pragma once

#include <string>
#include <vector>

namespace hagfish {

/// A heading and rows with as many fields.
using CsvTable = std::vector<std::vector<std::string>>;

/// Fields with a comma, quote or line break stand in quotes.
std::string csv_text(const CsvTable& table);

}  // namespace hagfish
