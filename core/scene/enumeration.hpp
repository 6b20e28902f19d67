// Tables that list an enumeration's values, each once, with what there is to say of them. Entries
// have `value` and `name`; the enumeration's own `last` is its last value.
#pragma once

#include <array>
#include <cstddef>

namespace hagfish {

template <class E>
inline constexpr std::size_t number_of_values = static_cast<std::size_t>(E::last) + 1;

template <class Entry>
using TableOf = std::array<Entry, number_of_values<decltype(Entry::value)>>;

/// Whether a table has each value once, with a name.
template <class Entry, std::size_t n>
constexpr bool lists_each_once(const std::array<Entry, n>& table) {
  std::array<bool, n> there{};
  for (const Entry& entry : table) {
    const auto k = static_cast<std::size_t>(entry.value);
    if (entry.name == nullptr || k >= n || there[k]) return false;
    there[k] = true;
  }
  return true;
}

/// Index of a value in a table that has it.
template <class Entry, std::size_t n, class E>
constexpr std::size_t index_in(const std::array<Entry, n>& table, E value) {
  std::size_t k = 0;
  while (table[k].value != value) ++k;
  return k;
}

/// Names by value.
template <class Entry, std::size_t n>
constexpr std::array<const char*, n> names_by_value(const std::array<Entry, n>& table) {
  std::array<const char*, n> names{};
  for (const Entry& entry : table) names[static_cast<std::size_t>(entry.value)] = entry.name;
  return names;
}

}  // namespace hagfish
