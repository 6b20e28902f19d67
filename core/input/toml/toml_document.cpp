#include "core/input/toml/toml_document.hpp"

#include <algorithm>
#include <sstream>

#include "core/input/input_error.hpp"
#include "core/input/scene_text.hpp"

namespace hagfish {
namespace {

/// The parser's many lines as one: what is wrong and, after the caret, what it wanted.
std::string condensed(std::string message) {
  std::string wanted;
  if (const auto caret = message.rfind("^---"); caret != std::string::npos) {
    wanted = message.substr(caret + 4);
    wanted = wanted.substr(0, wanted.find('\n'));
  }
  message = message.substr(0, message.find('\n'));
  for (const std::string_view prefix : {"[error] ", "toml::"}) {
    if (message.starts_with(prefix)) message.erase(0, prefix.size());
  }
  // What is left may begin with the parser's own function: "parse_array: ...".
  const auto colon = message.find(':');
  if (message.starts_with("parse_") || message.starts_with("insert_")) {
    message.erase(0, message.find_first_not_of(": ", colon));
  }
  return message + (wanted.empty() ? "" : " (" + wanted.substr(1) + ")");
}

std::string fault_in(const std::string& file, const toml::exception& error) {
  return file + ":" + std::to_string(error.location().line()) +
         ": not valid TOML: " + condensed(error.what());
}

toml::value parse(const std::string& text, const std::string& file) {
  if (!is_utf8(text) || text.find('\0') != std::string::npos) {
    throw_input_error(file + ": is not in UTF-8, the encoding of TOML: save it as UTF-8");
  }
  check_toml_bounds(text, file);
  try {
    std::istringstream stream(text);
    return toml::parse(stream, file);
  } catch (const toml::exception& error) {
    throw_input_error(fault_in(file, error));
  } catch (const std::exception& error) {
    throw_input_error(file + ": not valid TOML: " + condensed(error.what()));
  }
}

/// An override's value: TOML where it parses as one value, the bare text where not.
toml::value parse_value(const std::string& text) {
  try {
    toml::value parsed = parse("value = " + text, "--set");
    if (parsed.as_table().size() == 1) return parsed.at("value");
  } catch (const InputError&) {  // a bare string, and wrong only where no string is wanted
  }
  return toml::value(text);
}

/// NAME_rad for NAME_deg and back; empty for any other key.
std::string other_unit(const std::string& key) {
  const std::string name = key.substr(0, key.size() - std::min<std::size_t>(key.size(), 4));
  if (key.ends_with("_deg")) return name + "_rad";
  return key.ends_with("_rad") ? name + "_deg" : "";
}

/// Adds to `table` what only `base` has, table by table. An angle is the same key in either unit.
void merge(toml::value& table, const toml::value& base) {
  auto& values = table.as_table();
  for (const auto& [key, value] : base.as_table()) {
    const auto found = values.find(key);
    if (found != values.end()) {
      if (found->second.is_table() && value.is_table()) merge(found->second, value);
    } else if (!values.contains(other_unit(key))) {
      values.emplace(key, value);
    }
  }
}

}  // namespace

void TomlDocument::inherit(const TomlDocument& base) {
  merge(root, base.root);
  bases.insert(base.file);
  bases.insert(base.bases.begin(), base.bases.end());
  si_files.insert(base.si_files.begin(), base.si_files.end());
}

void TomlDocument::set(const Override& change, const std::string& shown) {
  toml::value* at = &root;
  std::istringstream parts(change.key);
  std::string part, walked;
  while (std::getline(parts, part, '.')) {
    if (at->is_uninitialized()) *at = toml::table();
    if (!at->is_table()) {
      throw_input_error(file + ": --set " + shown + "=" + shortened(change.value) + ": " + walked +
                        " is not a table");
    }
    walked = join_keys(walked, part);
    at->as_table().erase(other_unit(part));
    at = &at->as_table()[part];
  }
  *at = parse_value(change.value);
  overrides[change.key] = {shown, change.value};
}

const Override* TomlDocument::override_of(std::string full) const {
  for (;;) {
    const auto found = overrides.find(full);
    if (found != overrides.end()) return &found->second;
    const auto dot = full.rfind('.');
    if (dot == std::string::npos) return nullptr;
    full.erase(dot);
  }
}

std::string TomlDocument::file_of(const toml::value* value) const {
  if (!value) return file;
  const toml::source_location at = value->location();
  return bases.contains(at.file_name()) ? at.file_name() : file;
}

TomlDocument parse_toml(const std::string& text, const std::string& file) {
  return {file, parse(text, file), {}, {}, {}};
}

std::optional<std::string> toml_fault(const std::exception& thrown, const std::type_info& type) {
  if (type != typeid(toml::syntax_error)) return std::nullopt;
  const auto& error = static_cast<const toml::syntax_error&>(thrown);
  return fault_in(error.location().file_name(), error);
}

std::string toml_spelling(const toml::value& value) {
  const toml::source_location at = value.location();
  const std::string& line = at.line_str();
  const std::size_t start = std::min<std::size_t>(at.column() - 1, line.size());
  const std::string text = line.substr(start, at.region());
  return text.size() < at.region() ? shortened(text) + " ..." : shortened(text);
}

std::string join_keys(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : key.empty() ? path : path + "." + std::string(key);
}

}  // namespace hagfish
