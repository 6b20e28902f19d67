// Writes TOML by the calls that TableReader reads it with.
#pragma once

#include <Eigen/Core>
#include <array>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/input/toml/toml_range.hpp"

namespace hagfish {

/// Appends keys and tables to a text. Doubles keep every bit. Tables come after the keys of the
/// table that holds them. The writer ignores ranges and writes units of CGS. Throws
/// std::invalid_argument for a number that is not finite, which the reader would refuse.
class TomlWriter {
 public:
  const std::string& text() const { return text_; }

  void require(std::string_view) {}  ///< whoever calls it writes the key
  void only_cgs(std::initializer_list<std::string_view>) {}
  void string(std::string_view key, const std::string& value);
  void boolean(std::string_view key, bool value);
  void integer(std::string_view key, int value, const Range& range);
  void integer(std::string_view key, unsigned value, const Range& range);
  void number(std::string_view key, double value, const Range& range);
  /// Writes cm: a number that undoes a product with the body's length is not always there.
  void length(std::string_view key, double value, const Range& range);
  void vector(std::string_view key, const Eigen::Vector3d& value, Unit unit = cgs::one);
  void place(std::string_view key, const Eigen::Vector3d& value);
  void places(std::string_view key, const std::vector<Eigen::Vector3d>& value);
  /// No line where there are none: the reader wants one or more.
  void numbers(std::string_view key, const std::vector<double>& value, const Range& range);
  void rows(std::string_view key, std::string_view noun, std::string_view columns,
            const std::vector<Eigen::Vector4d>& value, Unit unit = cgs::one);
  void text_rows(std::string_view key, std::string_view noun, std::string_view form,
                 const std::vector<std::array<std::string, 3>>& value);
  /// Writes NAME_deg, or NAME_rad where no double of degrees gives `value` (rad) back exactly.
  void angle(std::string_view name, double value, const Range& range);
  void angles(std::string_view name, const std::vector<double>& value, const Range& range);

  template <class E>
  void choice(std::string_view key, const E& value, const Choices<E>& options) {
    for (const auto& [name, option] : options) {
      if (option == value) return string(key, std::string(name));
    }
    throw std::invalid_argument("no name for this value of " + std::string(key));
  }

  template <class Write>
  void table(std::string_view key, Write write) {
    const std::string parent = path_;
    path_ += (path_.empty() ? "" : ".") + std::string(key);
    text_ += "\n[" + path_ + "]\n";
    write(*this);
    path_ = parent;
  }

  /// Writes each of a list as a table of the array `key`, at the root; nothing where there are
  /// none.
  template <class T, class Write>
  void tables(std::string_view key, std::vector<T>& list, Write write) {
    for (T& one : list) {
      text_ += "\n[[" + std::string(key) + "]]\n";
      write(*this, one);
    }
  }

 private:
  void line(std::string_view key, const std::string& value);

  std::string text_;
  std::string path_;  ///< dotted, of the table being written
};

}  // namespace hagfish
