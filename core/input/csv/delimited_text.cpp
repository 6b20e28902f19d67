#include "core/input/csv/delimited_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

/// What Windows programs write before UTF-8, and before UTF-16 with the low byte first.
constexpr std::string_view utf8_mark = "\xEF\xBB\xBF", utf16_mark = "\xFF\xFE";

std::string narrow(std::string text) {
  if (text.starts_with(utf8_mark)) return text.substr(utf8_mark.size());
  if (!text.starts_with(utf16_mark)) return text;
  std::string narrow;  // letters beyond ASCII are in names alone
  for (std::size_t k = utf16_mark.size(); k + 1 < text.size(); k += 2) {
    narrow += text[k + 1] == 0 ? text[k] : '?';
  }
  return narrow;
}

std::string_view trimmed(std::string_view cell) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '"'; };
  while (!cell.empty() && blank(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && blank(cell.back())) cell.remove_suffix(1);
  return cell;
}

}  // namespace

DelimitedText::DelimitedText(std::string text) : text_(narrow(std::move(text))) {
  const std::string_view all = text_;
  std::size_t line = 0;
  bool known = false;
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find_first_of("\r\n", at), all.size());
    const std::string_view row = all.substr(at, end - at);
    ++line;
    at = end + (all.substr(end).starts_with("\r\n") ? 2 : 1);
    if (row.starts_with('#') || trimmed(row).empty()) continue;
    if (!known) {
      separator_ = row.find(';') != row.npos ? ';' : row.find('\t') != row.npos ? '\t' : ',';
      known = true;
    }
    first_.push_back(cell_.size());
    line_.push_back(line);
    bool quoted = false;
    std::size_t from = 0;
    for (std::size_t k = 0; k <= row.size(); ++k) {
      if (k < row.size() && row[k] == '"') quoted = !quoted;
      if (k < row.size() && (row[k] != separator_ || quoted)) continue;
      const std::string_view cell = trimmed(row.substr(from, k - from));
      cell_.push_back({static_cast<std::size_t>(cell.data() - all.data()), cell.size()});
      from = k + 1;
    }
  }
}

std::size_t DelimitedText::cells(std::size_t row) const {
  return (row + 1 < first_.size() ? first_[row + 1] : cell_.size()) - first_[row];
}

std::string_view DelimitedText::cell(std::size_t row, std::size_t column) const {
  if (column >= cells(row)) return {};
  const auto [begin, size] = cell_[first_[row] + column];
  return std::string_view(text_).substr(begin, size);
}

const char* DelimitedText::separator_name() const {
  return separator_ == ';' ? "semicolons" : separator_ == '\t' ? "tabs" : "commas";
}

std::optional<double> DelimitedText::number(std::size_t row, std::size_t column) const {
  const std::string_view cell = this->cell(row, column);
  std::string word;
  for (const char c : cell) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* missing : {"", "-", "nan", "na", "n/a", "null", "none"}) {
    if (word == missing) return NAN;
  }
  if (separator_ != ',' && word.find('.') == word.npos) {
    if (const std::size_t comma = word.find(','); comma != word.npos) word[comma] = '.';
  }
  return finite_number(word);
}

}  // namespace hagfish
