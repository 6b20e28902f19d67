#include "core/input/toml/toml_writer.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

namespace hagfish {
namespace {

std::string quoted(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04X", static_cast<unsigned>(c));
      text += code;
    } else {
      text += c;
    }
  }
  return text + '"';
}

std::string number_text(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("a scene file holds finite numbers only");
  std::string text = shortest(value);
  // TOML tells integers from floats by the spelling.
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

template <class Numbers>
std::string array_text(const Numbers& value) {
  std::string text = "[";
  for (const double x : value) text += (text.size() > 1 ? ", " : "") + number_text(x);
  return text + "]";
}

/// Degrees that the reader turns into exactly `rad`. Multiplication by pi / 180 skips some doubles.
std::optional<double> exact_degrees(double rad) {
  const double guess = rad * (180 / std::numbers::pi);
  const double below = std::nextafter(guess, -HUGE_VAL), above = std::nextafter(guess, HUGE_VAL);
  for (const double degrees : {std::round(guess), guess, below, above}) {
    if (degrees * (std::numbers::pi / 180) == rad) return degrees;
  }
  return std::nullopt;
}

}  // namespace

void TomlWriter::line(std::string_view key, const std::string& value) {
  text_ += std::string(key) + " = " + value + "\n";
}

void TomlWriter::string(std::string_view key, const std::string& value) {
  line(key, quoted(value));
}

void TomlWriter::boolean(std::string_view key, bool value) { line(key, value ? "true" : "false"); }

void TomlWriter::integer(std::string_view key, int value, const Range&) {
  line(key, std::to_string(value));
}

void TomlWriter::integer(std::string_view key, unsigned value, const Range&) {
  line(key, std::to_string(value));
}

void TomlWriter::number(std::string_view key, double value, const Range&) {
  line(key, number_text(value));
}

void TomlWriter::length(std::string_view key, double value, const Range& range) {
  number(key, value, range);
}

void TomlWriter::vector(std::string_view key, const Eigen::Vector3d& value, Unit) {
  line(key, array_text(value));
}

void TomlWriter::place(std::string_view key, const Eigen::Vector3d& value) { vector(key, value); }

void TomlWriter::places(std::string_view key, const std::vector<Eigen::Vector3d>& value) {
  std::string text = "[\n";
  for (const auto& point : value) text += "  " + array_text(point) + ",\n";
  line(key, text + "]");
}

void TomlWriter::numbers(std::string_view key, const std::vector<double>& value, const Range&) {
  if (!value.empty()) line(key, array_text(value));
}

void TomlWriter::rows(std::string_view key, std::string_view, std::string_view,
                      const std::vector<Eigen::Vector4d>& value, Unit) {
  std::string text = "[\n";
  for (const auto& row : value) text += "  " + array_text(row) + ",\n";
  line(key, text + "]");
}

void TomlWriter::text_rows(std::string_view key, std::string_view, std::string_view,
                           const std::vector<std::array<std::string, 3>>& value) {
  std::string text = "[\n";
  for (const auto& row : value) {
    text += "  [" + quoted(row[0]) + ", " + quoted(row[1]) + ", " + quoted(row[2]) + "],\n";
  }
  line(key, text + "]");
}

void TomlWriter::angle(std::string_view name, double value, const Range& range) {
  const auto degrees = exact_degrees(value);
  number(std::string(name) + (degrees ? "_deg" : "_rad"), degrees.value_or(value), range);
}

void TomlWriter::angles(std::string_view name, const std::vector<double>& value,
                        const Range& range) {
  std::vector<double> degrees;
  for (const double rad : value) {
    const auto exact = exact_degrees(rad);
    if (!exact) return numbers(std::string(name) + "_rad", value, range);
    degrees.push_back(*exact);
  }
  numbers(std::string(name) + "_deg", degrees, range);
}

}  // namespace hagfish
