// Kinds of rows, and of the forces that they give.
#pragma once

#include <array>
#include <cstdint>

#include "core/scene/enumeration.hpp"

namespace hagfish {

/// What a row is of. A step sums its forces in this order.
enum class RowKind : std::uint8_t {
  head,
  limit,
  contact,
  obstacle,
  thigmotaxis,
  last = thigmotaxis
};

struct RowKindEntry {
  RowKind value;
  const char* name;  ///< name in logs; "wall" dates from before other obstacles
  const char* description;
  bool from_outside = false;  ///< whether forces come from outside the animal
};

/// Kinds in the order in which logs and tables have them.
inline constexpr TableOf<RowKindEntry> row_kind_table{
    {{RowKind::thigmotaxis, "thigmotaxis", "f_thigmo = C_thigmo' lambda_thigmo / h (Eq. 8)"},
     {RowKind::contact, "contact", "self-contact"},
     {RowKind::limit, "limit", "joint limits"},
     {RowKind::head, "head", "head clamp", true},
     {RowKind::obstacle, "wall", "head plate and other obstacles", true}}};
static_assert(lists_each_once(row_kind_table));

/// Kinds in the order of the enumeration, which is the order of sums.
inline constexpr auto row_kinds = [] {
  std::array<RowKind, row_kind_table.size()> kinds{};
  for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k] = static_cast<RowKind>(k);
  return kinds;
}();

constexpr bool from_outside(RowKind kind) {
  return row_kind_table[index_in(row_kind_table, kind)].from_outside;
}

/// One T for each kind.
template <class T>
struct ByKind {
  std::array<T, row_kinds.size()> of_kind{};

  T& operator[](RowKind kind) { return of_kind[static_cast<std::size_t>(kind)]; }
  const T& operator[](RowKind kind) const { return of_kind[static_cast<std::size_t>(kind)]; }
};

}  // namespace hagfish
