#include "experiments/common/csv.hpp"

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

}  // namespace hagfish
