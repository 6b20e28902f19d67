#include "core/input/input_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "core/input/input_error.hpp"

namespace hagfish {
namespace {

constexpr std::size_t longest_quote = 60;    ///< bytes of a value that an error repeats
constexpr std::size_t longest_shown = 2000;  ///< bytes of a text that is printed
constexpr std::ptrdiff_t most_parts = 32;    ///< of a dotted key; scenes use 3

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

/// Bytes of the UTF-8 character that `text` begins with; 0 where that is none.
std::size_t character_size(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t size =
      first < 0xC2 || first > 0xF4 ? 0 : 2 + (first >= 0xE0 ? 1 : 0) + (first >= 0xF0 ? 1 : 0);
  if (size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return size;
}

/// Whether a character is one to control a terminal: below U+0020, and U+007F to U+009F.
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  return first < 0x20 || first == 0x7f ||
         (first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
}

}  // namespace

std::optional<LeadingNumber> leading_number(std::string_view text) {
#if defined(__cpp_lib_to_chars)
  LeadingNumber number{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number.value);
  number.size = static_cast<std::size_t>(read.ptr - text.data());
  return read.ec == std::errc() ? std::optional(number) : std::nullopt;
#else
  // A library without std::from_chars of numbers with a fraction, whose strtod() knows no locale.
  const bool minus = text.starts_with('-');
  const char first = text.size() > (minus ? 1 : 0) ? text[minus ? 1 : 0] : ' ';
  const bool hexadecimal =
      text.substr(minus ? 1 : 0).starts_with("0x") || text.substr(minus ? 1 : 0).starts_with("0X");
  if (!(first == '.' || (first >= '0' && first <= '9'))) return std::nullopt;
  if (hexadecimal) return LeadingNumber{minus ? -0.0 : 0.0, std::size_t{minus ? 2U : 1U}};
  const std::string ended(text);
  char* end = nullptr;
  const double value = std::strtod(ended.c_str(), &end);
  const auto size = static_cast<std::size_t>(end - ended.c_str());
  const bool written = size > 0 && std::isfinite(value);
  return written ? std::optional(LeadingNumber{value, size}) : std::nullopt;
#endif
}

std::optional<double> finite_number(std::string_view text) {
  const std::optional<LeadingNumber> number = leading_number(text);
  const bool whole = number && number->size == text.size() && std::isfinite(number->value);
  return whole ? std::optional(number->value) : std::nullopt;
}

std::string shortened(const std::string& text) {
  if (text.size() <= longest_quote) return text;
  std::size_t end = longest_quote;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + "...";
}

std::string printable(std::string_view text) {
  std::string shown;
  std::size_t at = 0;
  while (at < text.size() && at < longest_shown) {
    const std::size_t size = character_size(text.substr(at));
    if (size == 0 || is_control(text.substr(at, size))) {
      constexpr char digits[] = "0123456789abcdef";
      const auto byte = static_cast<unsigned char>(text[at]);
      shown += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
      ++at;
    } else {
      shown += text.substr(at, size);
      at += size;
    }
  }
  if (at < text.size()) shown += "... (" + std::to_string(text.size() - at) + " more bytes)";
  return shown;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t size = character_size(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
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
  const std::size_t slips =
      std::min((word.size() + 1) / 2, std::max<std::size_t>(2, word.size() / 3));
  const bool slip = edit_distance(word, near) <= slips;
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
  if (std::ranges::count(change.key, '.') >= most_parts) {
    throw_input_error("--set " + shortened(change.key) + ": has more than " +
                      std::to_string(most_parts) + " parts");
  }
  return change;
}

}  // namespace hagfish
