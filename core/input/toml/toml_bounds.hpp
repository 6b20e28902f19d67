// What a TOML text may ask of the parser, which goes one call deeper with each bracket and takes
// time by the square of the parts of a key.
#pragma once

#include <string>

namespace hagfish {

/// Brackets and braces within each other, and parts of a dotted key; scenes use three of both.
inline constexpr int deepest_toml = 32;

/// Throws InputError, naming `file` and the line, where `text` nests brackets deeper than
/// deepest_toml outside strings and comments, or has more names than that joined by dots. Any text
/// may come; whether it is TOML otherwise is for the parser to say.
void check_toml_bounds(const std::string& text, const std::string& file);

}  // namespace hagfish
