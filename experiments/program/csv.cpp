#include "experiments/program/csv.hpp"

#include <fmt/os.h>

#include <filesystem>
#include <system_error>

#include "core/log/hdf5_error.hpp"

namespace hagfish {
namespace {

std::string field(std::string text) {
  if (text.find_first_of(",\"\n") == std::string::npos) {
    return text;
  }
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) {
    text.insert(at, 1, '"');
  }
  return '"' + text + '"';
}

}  // namespace

void write_text(const std::string& file, const std::string& text) {
  try {
    auto out = fmt::output_file(file);
    out.print("{}", text);
    out.close();
  } catch (const std::system_error& error) {
    throw FileError(file + ": cannot be written: " + error.code().message());
  }
}

std::string csv_text(const CsvTable& table) {
  std::string text;
  for (const std::vector<std::string>& row : table) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += (i > 0 ? "," : "") + field(row[i]);
    }
    text += '\n';
  }
  return text;
}

void write_csv(const std::string& file, const CsvTable& table) {
  write_text(file, csv_text(table));
}

void try_csv(const std::string& file) {
  const std::string trial = file + ".part";
  write_text(trial, "");
  std::filesystem::remove(trial);
}

}  // namespace hagfish
