#include "core/input/input_text.hpp"

#include <algorithm>
#include <fstream>
#include <numeric>
#include <sstream>
#include <utility>

#include "core/input/input_error.hpp"

namespace hagfish {
namespace {

constexpr std::size_t longest_quote = 60;  ///< bytes of a value that an error repeats

/// Levenshtein distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string shortened(const std::string& text) {
  if (text.size() <= longest_quote) return text;
  std::size_t end = longest_quote;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + "...";
}

void throw_input_error(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  throw InputError(text);
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  const auto distance = [&](const std::string& a) { return edit_distance(word, a); };
  const auto best = std::ranges::min_element(candidates, {}, distance);
  return best == candidates.end() ? "" : *best;
}

std::string similar(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string near = nearest(word, candidates);
  const bool extended = near.starts_with(word) || word.starts_with(near);
  const bool slip = edit_distance(word, near) <= (word.size() + 1) / 2;
  return extended || slip ? near : "";
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string near = similar(word, candidates);
  return near.empty() ? "" : "; did you mean `" + near + "`?";
}

Override parse_override(std::string_view assignment) {
  const auto trimmed = [](std::string_view text) {
    const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
    return first == text.npos ? std::string() : std::string(text.substr(first, last - first + 1));
  };
  const auto equals = assignment.find('=');
  Override change{trimmed(assignment.substr(0, equals)), ""};
  if (equals != assignment.npos) change.value = trimmed(assignment.substr(equals + 1));
  const std::string dotted = "." + change.key + ".";
  if (equals == assignment.npos || dotted.find("..") != std::string::npos) {
    throw_input_error("--set " + shortened(std::string(assignment)) + ": must be KEY=VALUE");
  }
  return change;
}

std::string read_text_file(const std::filesystem::path& file) {
  // A directory opens as a file and reads as an empty one or worse, so it is checked first.
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw_input_error(file.string() + ": no such file");
  }
  if (error) throw_input_error(file.string() + ": cannot be read: " + error.message());
  if (std::filesystem::is_directory(status)) throw_input_error(file.string() + ": is a directory");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (stream.bad() || !stream.is_open()) throw_input_error(file.string() + ": cannot be read");
  return text.str();
}

}  // namespace hagfish
