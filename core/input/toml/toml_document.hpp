// A parsed TOML document, the values that it inherits and those that options put in. Included by
// the reader of tables only, which checks the values.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <toml.hpp>

#include "core/input/input_text.hpp"

namespace hagfish {

struct TomlDocument {
  std::string file;  ///< its name in errors
  toml::value root;
  std::set<std::string> bases;                ///< the files of inherited values
  std::set<std::string> si_files;             ///< files whose numbers are in SI
  std::map<std::string, Override> overrides;  ///< keyed by path here; `key` is the shown one
  double body_length = 0, body_diameter = 0;  ///< size of the animal, cm: units of lengths

  /// Takes from `base` what this document does not have, table by table.
  void inherit(const TomlDocument& base);

  /// Puts the value of `change` at its key, which errors call `shown`. Throws InputError where part
  /// of the path is no table.
  void set(const Override& change, const std::string& shown);

  /// The override that set `full`, a dotted path, or a table around it; nothing where none did.
  const Override* override_of(std::string full) const;

  /// The file that `value` was read from: this one unless a base has it.
  std::string file_of(const toml::value* value) const;
};

/// Throws InputError on bad syntax.
TomlDocument parse_toml(const std::string& text, const std::string& file);

// What a text may ask of the parser, which goes one call deeper with each bracket and takes time by
// the square of the parts of a key.

/// Brackets and braces within each other, and parts of a dotted key; scenes use three of both.
inline constexpr int deepest_toml = 32;

/// Throws InputError, naming `file` and the line, where `text` nests brackets deeper than
/// deepest_toml outside strings and comments, or has more names than that joined by dots. Any text
/// may come; whether it is TOML otherwise is for the parser to say.
void check_toml_bounds(const std::string& text, const std::string& file);

/// The value as its file spells it; only the first line of what spans several.
std::string toml_spelling(const toml::value& value);

/// A dotted path; either may be empty.
std::string join_keys(const std::string& path, std::string_view key);

}  // namespace hagfish
