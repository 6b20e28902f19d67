// Tables as CSV (RFC 4180, lines end with \n).
#pragma once

#include <string>
#include <vector>

namespace hagfish {

/// A heading and rows with as many fields.
using CsvTable = std::vector<std::vector<std::string>>;

/// Fields with a comma, quote or line break stand in quotes.
std::string csv_text(const CsvTable& table);

/// Throw FileError where `file` cannot be written.
void write_text(const std::string& file, const std::string& text);
void write_csv(const std::string& file, const CsvTable& table);

/// Throws FileError where the folder of `file` takes no files, which must show before the work, not
/// after.
void try_csv(const std::string& file);

}  // namespace hagfish
