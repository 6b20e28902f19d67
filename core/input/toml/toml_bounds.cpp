#include "core/input/toml/toml_document.hpp"

#include <algorithm>
#include <string_view>

#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

/// The end of the string, of one line or of several, that begins with the quote at `at`.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  const bool several = text.substr(at, 3) == three;
  const bool escapes = quote == '"';
  for (at += several ? 3 : 1; at < text.size(); ++at) {
    if (escapes && text[at] == '\\') {
      ++at;
    } else if (!several && (text[at] == quote || text[at] == '\n')) {
      return at + 1;  // a line that ends first is an error of the parser's
    } else if (several && text.substr(at, 3) == three) {
      // One or two more quotes belong to the string.
      return std::min(text.find_first_not_of(quote, at), at + 5);
    }
  }
  return text.size();
}

}  // namespace

void check_toml_bounds(const std::string& text, const std::string& file) {
  int depth = 0, dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = end_of_string(text, at);
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    depth += c == '[' || c == '{' ? 1 : 0;
    if (c == ']' || c == '}') depth = std::max(depth - 1, 0);
    dots = c == '.'                                                         ? dots + 1
           : std::string_view("=,[]{}\n").find(c) != std::string_view::npos ? 0
                                                                            : dots;
    if (depth > deepest_toml || dots >= deepest_toml) {
      const auto line =
          1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      throw_input_error(file + ":" + std::to_string(line) + ": not a scene: " +
                        (dots >= deepest_toml ? "a key of more than " : "brackets deeper than ") +
                        std::to_string(deepest_toml) + (dots >= deepest_toml ? " parts" : ""));
    }
    ++at;
  }
}

}  // namespace hagfish
