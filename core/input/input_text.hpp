// Text of files and options on its way in, and of the errors about it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hagfish {

/// One `--set KEY=VALUE` of the command line.
struct Override {
  std::string key;    ///< dotted
  std::string value;  ///< value as typed; TOML, or the bare text of a string
};

/// Splits "KEY=VALUE" at the first '='. Throws InputError where there is none or KEY has an empty
/// part or more than 32.
Override parse_override(std::string_view assignment);

/// Throws InputError with `text` on one line: control characters become spaces.
[[noreturn]] void throw_input_error(std::string text);

/// `text` for a terminal: bytes that a terminal would obey (control characters) or that are no
/// UTF-8 as \\xNN; of more than 2000 bytes the first ones, and how many more there are.
std::string printable(std::string_view text);

/// Whether `text` is UTF-8 throughout.
bool is_utf8(std::string_view text);

/// A number that a text begins with, and how many bytes of the text it is.
struct LeadingNumber {
  double value = 0;
  std::size_t size = 0;
};

/// The decimal number that `text` begins with, in whatever locale; none where it begins with
/// anything else, such as a space or a plus, or where no double is as large.
std::optional<LeadingNumber> leading_number(std::string_view text);

/// The finite number that the whole of `text` is; none where it is anything else.
std::optional<double> finite_number(std::string_view text);

/// The first 60 bytes or so of `text`, in whole UTF-8 characters, with dots for what is left off.
std::string shortened(const std::string& text);

/// The candidate with the least edit distance to `word`; empty where there is no candidate.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// The nearest candidate that `word` may be a slip of: up to half of its letters are others, or one
/// begins with the other. Empty where there is none.
std::string similar(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean `CANDIDATE`?" of the similar one; empty where there is none.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace hagfish
