// A checked layer over a TOML parser: every value is read by name, type and range, and every
// error is an InputError of one line, `FILE:LINE: KEY = VALUE: why`.
//
// TableReader and TomlWriter (toml_writer.hpp) have the same functions for what a scene holds, so
// that one list of fields (scene_fields.hpp) serves to read and to write. No key may be read twice
// from one TableReader.
#pragma once

#include <Eigen/Core>
#include <array>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/input/toml/toml_range.hpp"

namespace hagfish {

/// One table of a TOML document. The getters leave `value` as it is where the key is absent.
class TableReader {
 public:
  /// The root table of `text`; `file` is its name in errors. Throws InputError on bad syntax.
  TableReader(const std::string& text, const std::string& file);
  TableReader(TableReader&&) noexcept;
  ~TableReader();

  /// Reads the key `units` of this root, "CGS" where it is absent: what the numbers of its file are
  /// in, overrides among them, but never those of a base. Comes before inherit().
  void read_units();

  /// Takes from `base` what this table does not have, table by table; arrays are not merged. Both
  /// are roots. Errors about such a value name the file of `base`. Comes before set().
  void inherit(const TableReader& base);

  /// Puts `value` at the dotted `key` below this table, which must be a root. Errors about it say
  /// `--set SHOWN=VALUE` from then on. Comes before any getter.
  void set(const Override& change, const std::string& shown);

  /// Length and mean diameter of the animal, cm, for length() of this table and all in it.
  void set_body(double length, double diameter);

  /// Makes an absent key an error from here on, reported by finish().
  void require_all();

  bool has(std::string_view key) const;
  /// Throws InputError where `key` is absent.
  void require(std::string_view key) const;
  /// Throws InputError where one of `keys` stands in a file of SI.
  void only_cgs(std::initializer_list<std::string_view> keys) const;
  /// Whether the number at the dotted `key` stands in a file of SI.
  bool in_si(std::string_view key) const;
  bool is_table(std::string_view key) const;
  bool is_array(std::string_view key) const;
  bool was_set(std::string_view key) const;  ///< whether set() put it there
  /// The file that the value at the dotted `key` was read from: this table's, or a base's.
  std::string file_of(std::string_view key) const;

  void string(std::string_view key, std::string& value);
  void boolean(std::string_view key, bool& value);
  void integer(std::string_view key, int& value, const Range& range);
  void integer(std::string_view key, unsigned& value, const Range& range);
  /// A finite number, turned from SI into `range.unit` where its file is in SI; TOML integers count
  /// as numbers.
  void number(std::string_view key, double& value, const Range& range);
  /// A length in cm: a number, or a string of a number and its unit, "0.2 L" of body lengths or
  /// "12 D" of mean diameters, as set_body() has said. `range` is in either.
  void length(std::string_view key, double& value, const Range& range);
  /// Three numbers in an array, each as number() reads it.
  void vector(std::string_view key, Eigen::Vector3d& value, Unit unit = cgs::one);
  /// A place in the world: three lengths in an array, each as length() reads it.
  void place(std::string_view key, Eigen::Vector3d& value);
  /// One or more places in an array, each as place() reads it.
  void places(std::string_view key, std::vector<Eigen::Vector3d>& value);
  /// One or more numbers in an array, each as number() reads it.
  void numbers(std::string_view key, std::vector<double>& value, const Range& range);
  /// An array of arrays of four numbers; errors call an element `noun`, count from 1 and name its
  /// `columns`, "t, x, y, z", of which all but the first are in `unit`.
  void rows(std::string_view key, std::string_view noun, std::string_view columns,
            std::vector<Eigen::Vector4d>& value, Unit unit = cgs::one);
  /// An array of arrays of three strings, which errors show as `form`; a number but in the first
  /// place is taken as its shortest text.
  void text_rows(std::string_view key, std::string_view noun, std::string_view form,
                 std::vector<std::array<std::string, 3>>& value);
  /// An array of one or more values of any kind, each as text that an override takes: numbers as
  /// their shortest text, strings bare, arrays of all these in brackets.
  void values(std::string_view key, std::vector<std::string>& value);
  /// Keys of this table, in the order in which the file has their values.
  std::vector<std::string> keys() const;
  /// An angle in rad, read from NAME_deg or NAME_rad; `range` is in degrees.
  void angle(std::string_view name, double& value, const Range& range);
  /// One or more angles in an array, each as angle() reads it.
  void angles(std::string_view name, std::vector<double>& value, const Range& range);

  /// A string out of a fixed list.
  template <class E>
  void choice(std::string_view key, E& value, const Choices<E>& options) {
    std::vector<std::string_view> names;
    for (const auto& option : options) names.push_back(option.first);
    if (const auto index = choice_index(key, names)) value = options[*index].second;
  }

  /// Reads the table `key` with `read(TableReader&)`, as an empty one where it is absent.
  template <class Read>
  void table(std::string_view key, Read read) {
    TableReader child = open(key);
    read(child);
    child.finish();
  }

  /// Reads each table of the array of tables `key` with `read(TableReader&)`; none where it is
  /// absent. Errors count them from 1.
  template <class Read>
  void tables(std::string_view key, Read read) {
    for (TableReader& child : open_all(key)) {
      read(child);
      child.finish();
    }
  }

  /// Reads them into a list by `read(TableReader&, T&)`, one by one; leaves it as it is where the
  /// key is absent.
  template <class T, class Read>
  void tables(std::string_view key, std::vector<T>& list, Read read) {
    if (!has(key)) return;
    list.clear();
    tables(key, [&](TableReader& child) { read(child, list.emplace_back()); });
  }

  /// Ends the reading: throws InputError for a key that was not read (with the nearest one that
  /// was), then for the first required key that is absent.
  void finish() const;

  /// Throws InputError about `key`, a dotted path below this table.
  [[noreturn]] void fail(std::string_view key, const std::string& why) const;
  /// Throws InputError about one element, counted from 0, of the array at `key`.
  [[noreturn]] void fail_element(std::string_view key, std::size_t index,
                                 const std::string& why) const;

 private:
  struct Impl;
  explicit TableReader(std::unique_ptr<Impl> impl);
  TableReader open(std::string_view key);
  std::vector<TableReader> open_all(std::string_view key);
  std::optional<std::size_t> choice_index(std::string_view key,
                                          const std::vector<std::string_view>& names);

  std::unique_ptr<Impl> impl_;
};

}  // namespace hagfish
