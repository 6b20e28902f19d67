#include "core/input/toml/toml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <tuple>

#include "core/input/toml/toml_document.hpp"

namespace hagfish {
namespace {

constexpr const char* numbers_wanted = "must be an array of numbers";
/// No place of a scene is further from the origin along an axis, cm.
constexpr double largest_place = 1e6;

/// A range in degrees converted to the unit that is `unit` rad.
Range in_unit(Range degrees, double unit) {
  const double factor = std::numbers::pi / 180 / unit;
  if (std::isfinite(degrees.high)) degrees.rule += " degrees";
  degrees.low *= factor;
  degrees.high *= factor;
  return degrees;
}

}  // namespace

struct TableReader::Impl {
  /// What an error is about: a key, the value to quote, and words to put before the reason.
  struct Entry {
    std::string key;
    const toml::value* value = nullptr;  ///< nothing where the key is absent
    std::string subject = {};
  };

  std::shared_ptr<TomlDocument> document;
  const toml::value* table = nullptr;  ///< nothing where the file has no such table
  const toml::value* other = nullptr;  ///< what stands in place of a table
  std::string path;
  bool all_required = false;
  std::vector<std::string> known, missing;

  const toml::value* peek(std::string_view key) const {
    if (!table) return nullptr;
    const auto found = table->as_table().find(std::string(key));
    return found == table->as_table().end() ? nullptr : &found->second;
  }

  /// The value at a dotted path below this table.
  const toml::value* walk(const std::string& dotted) const {
    const toml::value* at = table;
    std::istringstream parts(dotted);
    for (std::string part; at && std::getline(parts, part, '.');) {
      const auto found = at->as_table().find(part);
      at = found == at->as_table().end() ? nullptr : &found->second;
    }
    return at;
  }

  std::string keys_there_are() const {
    std::string names;
    for (const std::string& key : known) names += (names.empty() ? "" : ", ") + key;
    return "there are " + names;
  }

  /// What stands at `key`, which counts as read.
  Entry ask(std::string_view key) {
    known.emplace_back(key);
    const toml::value* value = peek(key);
    if (!value && all_required) missing.emplace_back(key);
    return {std::string(key), value};
  }

  /// What stands at NAME_deg or NAME_rad, and the factor from its unit to rad.
  std::pair<Entry, double> ask_angle(std::string_view name) {
    const std::string degrees = std::string(name) + "_deg", radians = std::string(name) + "_rad";
    if (peek(degrees) && peek(radians)) {
      fail({radians, peek(radians)}, degrees + " is also given; give only one");
    }
    const bool in_rad = peek(radians);
    const Entry entry = ask(in_rad ? radians : degrees);
    known.push_back(in_rad ? degrees : radians);
    return {entry, in_rad ? 1 : std::numbers::pi / 180};
  }

  [[noreturn]] void fail(const Entry& entry, const std::string& why) const {
    const std::string full = join_keys(path, entry.key);
    const std::string reason = entry.subject + why;
    if (const Override* change = document->override_of(full)) {
      const bool itself = document->overrides.contains(full);
      throw_input_error(document->file + ": --set " + change->key + "=" + shortened(change->value) +
                        ": " + (itself ? "" : full + " ") + reason);
    }
    // A table that is there by an override of something in it.
    const auto within = document->overrides.lower_bound(full + ".");
    if (within != document->overrides.end() && within->first.starts_with(full + ".")) {
      const Override& change = within->second;
      throw_input_error(document->file + ": --set " + change.key + "=" + shortened(change.value) +
                        ": " + full + ": " + reason);
    }
    const std::string file = document->file_of(entry.value);
    std::string text = file;
    if (entry.value) text += ":" + std::to_string(entry.value->location().line());
    if (file != document->file) text += " (base of " + document->file + ")";
    text += ": " + full;
    if (entry.value && !entry.value->is_table()) text += " = " + toml_spelling(*entry.value);
    throw_input_error(text + ": " + reason);
  }

  bool in_si(const toml::value& value) const {
    return !document->si_files.empty() && document->si_files.contains(document->file_of(&value));
  }

  double checked(const Entry& entry, const toml::value& value, const Range& range) const {
    double x = 0;
    if (value.is_integer()) {
      x = static_cast<double>(integral(entry, value));
    } else if (value.is_floating()) {
      x = value.as_floating();
    } else {
      fail(entry, "must be a number");
    }
    // The parser reads a number that overflows as the largest double.
    if (!std::isfinite(x) || std::abs(x) == std::numeric_limits<double>::max()) {
      fail(entry, "must be finite");
    }
    const bool si = range.unit.per_si != 1 && in_si(value);
    if (si) x *= range.unit.per_si;
    if (!range.contains(x)) {
      const bool says_number = range.low != 0 || std::isfinite(range.high);
      fail(entry, range.rule + (si && says_number ? std::string(" ") + range.unit.cgs : ""));
    }
    return x;
  }

  std::int64_t integral(const Entry& entry, const toml::value& value) const {
    if (!value.is_integer()) fail(entry, "must be a whole number");
    const std::int64_t n = value.as_integer();
    // The parser clamps an integer that overflows.
    if (n == std::numeric_limits<std::int64_t>::max() ||
        n == std::numeric_limits<std::int64_t>::min()) {
      fail(entry, "does not fit 64 bits");
    }
    return n;
  }

  /// The numbers of an array of `size`, or of one or more where `size` is 0.
  std::vector<double> array(const Entry& entry, const Range& range, std::size_t size,
                            const std::string& shape) const {
    if (!entry.value->is_array()) fail(entry, shape);
    const auto& elements = entry.value->as_array();
    if (elements.empty() || (size > 0 && elements.size() != size)) fail(entry, shape);
    std::vector<double> numbers;
    for (const auto& element : elements) {
      const std::string which = "number " + std::to_string(numbers.size() + 1) + " ";
      numbers.push_back(checked({entry.key, entry.value, entry.subject + which}, element, range));
    }
    return numbers;
  }

  /// The text of an override with this value; a string in quotes only where it is `inside` an
  /// array.
  std::string override_text(const Entry& entry, const toml::value& value, bool inside) const {
    if (value.is_string()) return inside ? toml::format(value) : value.as_string().str;
    if (value.is_boolean()) return value.as_boolean() ? "true" : "false";
    if (value.is_integer()) return std::to_string(integral(entry, value));
    if (value.is_floating()) return shortest(checked(entry, value, any_number()));
    if (!value.is_array()) fail(entry, "must be a number, a text, true or false, or an array");
    std::string text;
    for (const auto& element : value.as_array()) {
      text += (text.empty() ? "" : ", ") + override_text(entry, element, true);
    }
    return "[" + text + "]";
  }

  /// A length as TableReader::length() has it, cm.
  double length(const Entry& entry, const toml::value& value, const Range& range) const {
    if (!value.is_string()) {
      Range in_cm = range;
      in_cm.unit = cgs::cm;
      return checked(entry, value, in_cm);
    }
    const std::string& text = value.as_string().str;
    const std::optional<LeadingNumber> number = leading_number(text);
    const std::string unit = number ? text.substr(number->size) : "";
    if (!number || (unit != " L" && unit != " D")) {
      fail(entry, std::string("must be a number of ") + (in_si(value) ? "m" : "cm") +
                      ", or as \"0.2 L\" or \"12 D\", of body lengths or mean "
                      "diameters");
    }
    return checked(entry, toml::value(number->value), range) *
           (unit == " L" ? document->body_length : document->body_diameter);
  }

  /// Three lengths.
  Eigen::Vector3d place(const Entry& entry, const toml::value& value) const {
    if (!value.is_array() || value.size() != 3) fail(entry, "must be three lengths [x, y, z]");
    const Range range = within(-largest_place, largest_place);
    Eigen::Vector3d at;
    for (int i = 0; i < 3; ++i) at[i] = length(entry, value.at(i), range);
    return at;
  }

  template <class Integer>
  void integer(std::string_view key, Integer& value, const Range& range) {
    const Entry entry = ask(key);
    if (!entry.value) return;
    const std::int64_t n = integral(entry, *entry.value);
    if (!std::in_range<Integer>(n)) fail(entry, "is out of range");
    if (!range.contains(static_cast<double>(n))) fail(entry, range.rule);
    value = static_cast<Integer>(n);
  }
};

TableReader::TableReader(const std::string& text, const std::string& file)
    : impl_(std::make_unique<Impl>()) {
  impl_->document = std::make_shared<TomlDocument>(parse_toml(text, file));
  impl_->table = &impl_->document->root;
}

TableReader::TableReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TableReader::TableReader(TableReader&&) noexcept = default;
TableReader::~TableReader() = default;

void TableReader::read_units() {
  bool si = false;
  choice<bool>("units", si, {{"CGS", false}, {"SI", true}});
  if (si) impl_->document->si_files.insert(impl_->document->file);
}

void TableReader::inherit(const TableReader& base) {
  impl_->document->inherit(*base.impl_->document);
}

void TableReader::set(const Override& change, const std::string& shown) {
  impl_->document->set(change, shown);
}

void TableReader::require_all() { impl_->all_required = true; }

bool TableReader::has(std::string_view key) const { return impl_->peek(key); }

void TableReader::require(std::string_view key) const {
  if (!has(key)) fail(key, "is missing");
}

bool TableReader::in_si(std::string_view key) const {
  const toml::value* value = impl_->walk(std::string(key));
  return value && impl_->in_si(*value);
}

void TableReader::only_cgs(std::initializer_list<std::string_view> keys) const {
  for (const std::string_view key : keys) {
    if (in_si(key)) fail(key, "has numbers of several units: use a file without units = \"SI\"");
  }
}

bool TableReader::is_table(std::string_view key) const {
  const toml::value* value = impl_->peek(key);
  return value && value->is_table();
}

bool TableReader::is_array(std::string_view key) const {
  const toml::value* value = impl_->peek(key);
  return value && value->is_array();
}

std::string TableReader::file_of(std::string_view key) const {
  return impl_->document->file_of(impl_->walk(std::string(key)));
}

bool TableReader::was_set(std::string_view key) const {
  return impl_->document->overrides.contains(join_keys(impl_->path, key));
}

void TableReader::string(std::string_view key, std::string& value) {
  const Impl::Entry entry = impl_->ask(key);
  if (!entry.value) return;
  if (entry.value->is_string()) {
    value = entry.value->as_string().str;
  } else if (was_set(key)) {
    // --set title=2 is a title too.
    value = impl_->document->override_of(join_keys(impl_->path, key))->value;
  } else {
    impl_->fail(entry, "must be a string in quotes");
  }
}

void TableReader::boolean(std::string_view key, bool& value) {
  const Impl::Entry entry = impl_->ask(key);
  if (!entry.value) return;
  if (!entry.value->is_boolean()) impl_->fail(entry, "must be true or false");
  value = entry.value->as_boolean();
}

void TableReader::integer(std::string_view key, int& value, const Range& range) {
  impl_->integer(key, value, range);
}

void TableReader::integer(std::string_view key, unsigned& value, const Range& range) {
  impl_->integer(key, value, range);
}

void TableReader::number(std::string_view key, double& value, const Range& range) {
  const Impl::Entry entry = impl_->ask(key);
  if (entry.value) value = impl_->checked(entry, *entry.value, range);
}

void TableReader::set_body(double length, double diameter) {
  impl_->document->body_length = length;
  impl_->document->body_diameter = diameter;
}

void TableReader::length(std::string_view key, double& value, const Range& range) {
  const Impl::Entry entry = impl_->ask(key);
  if (entry.value) value = impl_->length(entry, *entry.value, range);
}

void TableReader::place(std::string_view key, Eigen::Vector3d& value) {
  const Impl::Entry entry = impl_->ask(key);
  if (entry.value) value = impl_->place(entry, *entry.value);
}

void TableReader::places(std::string_view key, std::vector<Eigen::Vector3d>& value) {
  const Impl::Entry entry = impl_->ask(key);
  if (!entry.value) return;
  if (!entry.value->is_array() || entry.value->as_array().empty()) {
    impl_->fail(entry, "must be an array of points [x, y, z]");
  }
  value.clear();
  for (const auto& point : entry.value->as_array()) {
    const std::string which = "point " + std::to_string(value.size() + 1) + " ";
    value.push_back(impl_->place({entry.key, &point, which}, point));
  }
}

void TableReader::vector(std::string_view key, Eigen::Vector3d& value, Unit unit) {
  const Impl::Entry entry = impl_->ask(key);
  if (!entry.value) return;
  const auto x = impl_->array(entry, any_number(unit), 3, "must be three numbers [x, y, z]");
  value = Eigen::Vector3d::Map(x.data());
}

void TableReader::numbers(std::string_view key, std::vector<double>& value, const Range& range) {
  const Impl::Entry entry = impl_->ask(key);
  if (entry.value) value = impl_->array(entry, range, 0, numbers_wanted);
}

void TableReader::rows(std::string_view key, std::string_view noun, std::string_view columns,
                       std::vector<Eigen::Vector4d>& value, Unit unit) {
  const Impl::Entry entry = impl_->ask(key);
  if (!entry.value) return;
  const std::string shape = "[" + std::string(columns) + "]";
  if (!entry.value->is_array()) impl_->fail(entry, "must be an array of arrays " + shape);
  value.clear();
  for (const auto& row : entry.value->as_array()) {
    const std::string which = std::string(noun) + " " + std::to_string(value.size() + 1) + " ";
    const auto numbers =
        impl_->array({entry.key, &row, which}, any_number(), 4, "must be four numbers " + shape);
    value.emplace_back(Eigen::Vector4d::Map(numbers.data()));
    if (impl_->in_si(row)) value.back().tail<3>() *= unit.per_si;
  }
}

void TableReader::text_rows(std::string_view key, std::string_view noun, std::string_view form,
                            std::vector<std::array<std::string, 3>>& value) {
  const Impl::Entry entry = impl_->ask(key);
  if (!entry.value) return;
  const std::string wanted = "must be an array of arrays " + std::string(form);
  if (!entry.value->is_array()) impl_->fail(entry, wanted);
  value.clear();
  for (const auto& row : entry.value->as_array()) {
    const std::string which = std::string(noun) + " " + std::to_string(value.size() + 1) + " ";
    const Impl::Entry here{entry.key, &row, which};
    if (!row.is_array() || row.size() != 3 || !row.at(0).is_string()) {
      impl_->fail(here, "must be " + std::string(form));
    }
    std::array<std::string, 3> texts;
    for (std::size_t i = 0; i < 3; ++i) {
      texts[i] = row.at(i).is_string() ? row.at(i).as_string().str
                                       : shortest(impl_->checked(here, row.at(i), any_number()));
    }
    value.push_back(texts);
  }
}

void TableReader::values(std::string_view key, std::vector<std::string>& value) {
  const Impl::Entry entry = impl_->ask(key);
  if (!entry.value) return;
  if (!entry.value->is_array()) impl_->fail(entry, "must be an array");
  if (entry.value->as_array().empty()) impl_->fail(entry, "holds no value");
  value.clear();
  for (const auto& element : entry.value->as_array()) {
    const std::string which = "value " + std::to_string(value.size() + 1) + " ";
    value.push_back(impl_->override_text({entry.key, entry.value, which}, element, false));
  }
}

std::vector<std::string> TableReader::keys() const {
  using LinedKey = std::tuple<std::uint_least32_t, std::uint_least32_t, std::string>;
  std::vector<LinedKey> found;
  if (impl_->table) {
    for (const auto& [key, value] : impl_->table->as_table()) {
      found.emplace_back(value.location().line(), value.location().column(), key);
    }
  }
  std::ranges::sort(found);
  std::vector<std::string> names;
  for (const LinedKey& key : found) names.push_back(std::get<std::string>(key));
  return names;
}

void TableReader::angle(std::string_view name, double& value, const Range& range) {
  const auto [entry, unit] = impl_->ask_angle(name);
  if (entry.value) value = impl_->checked(entry, *entry.value, in_unit(range, unit)) * unit;
}

void TableReader::angles(std::string_view name, std::vector<double>& value, const Range& range) {
  const auto [entry, unit] = impl_->ask_angle(name);
  if (!entry.value) return;
  value = impl_->array(entry, in_unit(range, unit), 0, numbers_wanted);
  for (double& x : value) x *= unit;
}

std::optional<std::size_t> TableReader::choice_index(std::string_view key,
                                                     const std::vector<std::string_view>& names) {
  std::string word;
  string(key, word);
  const toml::value* found = impl_->peek(key);
  if (!found) return std::nullopt;
  const auto match = std::ranges::find(names, word);
  if (match != names.end()) return static_cast<std::size_t>(match - names.begin());
  std::string list;
  for (const auto name : names) list += (list.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  impl_->fail({std::string(key), found}, "must be one of " + list);
}

TableReader TableReader::open(std::string_view key) {
  auto child = std::make_unique<Impl>();
  child->document = impl_->document;
  const Impl::Entry entry = impl_->ask(key);
  child->path = join_keys(impl_->path, key);
  // What is no table is refused by finish(), which knows the keys that a table would have.
  const bool is_table = entry.value && entry.value->is_table();
  (is_table ? child->table : child->other) = entry.value;
  return TableReader(std::move(child));
}

std::vector<TableReader> TableReader::open_all(std::string_view key) {
  std::vector<TableReader> children;
  const Impl::Entry entry = impl_->ask(key);
  if (!entry.value) return children;
  if (!entry.value->is_array()) impl_->fail(entry, "must be an array of tables");
  for (const auto& element : entry.value->as_array()) {
    if (!element.is_table()) impl_->fail(entry, "must be an array of tables");
    auto child = std::make_unique<Impl>();
    child->document = impl_->document;
    child->table = &element;
    child->path = join_keys(impl_->path, key) + " " + std::to_string(children.size() + 1);
    children.push_back(TableReader(std::move(child)));
  }
  return children;
}

void TableReader::finish() const {
  if (impl_->other) {
    impl_->fail({"", impl_->other}, "must be a table; in it " + impl_->keys_there_are());
  }
  if (impl_->table) {
    // The parser keeps no order: of several unknown keys, the first by name is reported.
    std::map<std::string, const toml::value*> strangers;
    for (const auto& [key, value] : impl_->table->as_table()) {
      if (std::ranges::find(impl_->known, key) == impl_->known.end()) strangers[key] = &value;
    }
    if (!strangers.empty()) {
      const auto& [key, value] = *strangers.begin();
      const std::string near = similar(key, impl_->known);
      impl_->fail({key, value},
                  near.empty() ? "unknown key; " + impl_->keys_there_are()
                               : "unknown key; did you mean " + join_keys(impl_->path, near) + "?");
    }
  }
  if (!impl_->missing.empty()) fail(impl_->missing.front(), "is missing");
}

void TableReader::fail(std::string_view key, const std::string& why) const {
  const std::string dotted(key);
  impl_->fail({dotted, impl_->walk(dotted)}, why);
}

void TableReader::fail_element(std::string_view key, std::size_t index,
                               const std::string& why) const {
  const std::string dotted(key);
  impl_->fail({dotted, &impl_->walk(dotted)->as_array().at(index)}, why);
}

}  // namespace hagfish
