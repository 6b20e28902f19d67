// Knot types by name.
#include <algorithm>
#include <array>
#include <charconv>

#include "core/knot/knot.hpp"

namespace hagfish {
namespace {

/// Prime knots of up to seven crossings: |Alexander polynomial at -1|, and half its second
/// derivative at 1 (Rolfsen's table). All differ.
constexpr auto table = std::to_array<NamedKnot>({{"0_1", {1, 0}},
                                                 {"3_1", {3, 1}},
                                                 {"4_1", {5, -1}},
                                                 {"5_1", {5, 3}},
                                                 {"5_2", {7, 2}},
                                                 {"6_1", {9, -2}},
                                                 {"6_2", {11, -1}},
                                                 {"6_3", {13, 1}},
                                                 {"7_1", {7, 6}},
                                                 {"7_2", {11, 3}},
                                                 {"7_3", {13, 5}},
                                                 {"7_4", {15, 4}},
                                                 {"7_5", {17, 4}},
                                                 {"7_6", {19, 1}},
                                                 {"7_7", {21, -1}}});

/// Whether `text` is `prefix` and a whole number, which goes to `number`.
bool number_after(std::string_view prefix, std::string_view text, int& number) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end;
}

}  // namespace

std::span<const NamedKnot> named_knots() { return table; }

std::string invariants_text(const KnotInvariants& type) {
  return "det=" + std::to_string(type.determinant) + ",v2=" + std::to_string(type.v2);
}

std::string knot_name(const KnotInvariants& type) {
  const auto* const found =
      std::ranges::find(table, type, [](const NamedKnot& knot) { return knot.type; });
  if (found != table.end()) return found->name;
  return invariants_text(type);
}

std::string knot_words(std::string_view name) {
  constexpr std::pair<std::string_view, const char*> called[] = {{"0_1", "no knot"},
                                                                 {"3_1", "overhand, 3_1"},
                                                                 {"4_1", "figure-eight, 4_1"},
                                                                 {"5_1", "double overhand, 5_1"},
                                                                 {"5_2", "three-twist, 5_2"}};
  const auto* const found =
      std::ranges::find(called, name, [](const auto& knot) { return knot.first; });
  return found != std::end(called) ? found->second : std::string(name);
}

std::string a_knot(std::string_view name) {
  return name == "0_1" ? knot_words(name) : "a knot (" + knot_words(name) + ")";
}

std::optional<KnotInvariants> knot_called(std::string_view name) {
  const auto* const found = std::ranges::find(table, name, &NamedKnot::name);
  if (found != table.end()) return found->type;
  KnotInvariants type;
  const std::size_t comma = name.find(',');
  if (comma == std::string_view::npos ||
      !number_after("det=", name.substr(0, comma), type.determinant) ||
      !number_after("v2=", name.substr(comma + 1), type.v2) || knot_name(type) != name) {
    return std::nullopt;
  }
  return type;
}

}  // namespace hagfish
