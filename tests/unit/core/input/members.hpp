// The members of a plain struct, one after the other, so that no test has to list them.
#pragma once

#include <cstddef>
#include <type_traits>

namespace hagfish {

/// What any member of an aggregate can be initialised with.
struct AnyMember {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor): implicit by design
};

/// How many members an aggregate has.
template <class T, class... Members>
consteval std::size_t member_count() {
  if constexpr (requires { T{Members{}..., AnyMember{}}; }) {
    return member_count<T, Members..., AnyMember>();
  } else {
    return sizeof...(Members);
  }
}

/// Calls `visit` with each member of `plain`, a struct without a base or arrays.
template <class Struct, class Visit>
void for_each_member(Struct& plain, Visit&& visit) {
  constexpr std::size_t count = member_count<std::remove_const_t<Struct>>();
  const auto all = [&visit](auto&... members) { (visit(members), ...); };
  if constexpr (count == 2) {
    auto& [a, b] = plain;
    all(a, b);
  } else if constexpr (count == 3) {
    auto& [a, b, c] = plain;
    all(a, b, c);
  } else if constexpr (count == 4) {
    auto& [a, b, c, d] = plain;
    all(a, b, c, d);
  } else if constexpr (count == 5) {
    auto& [a, b, c, d, e] = plain;
    all(a, b, c, d, e);
  } else if constexpr (count == 6) {
    auto& [a, b, c, d, e, f] = plain;
    all(a, b, c, d, e, f);
  } else if constexpr (count == 7) {
    auto& [a, b, c, d, e, f, g] = plain;
    all(a, b, c, d, e, f, g);
  } else if constexpr (count == 8) {
    auto& [a, b, c, d, e, f, g, h] = plain;
    all(a, b, c, d, e, f, g, h);
  } else if constexpr (count == 9) {
    auto& [a, b, c, d, e, f, g, h, i] = plain;
    all(a, b, c, d, e, f, g, h, i);
  } else if constexpr (count == 10) {
    auto& [a, b, c, d, e, f, g, h, i, j] = plain;
    all(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (count == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = plain;
    all(a, b, c, d, e, f, g, h, i, j, k);
  } else if constexpr (count == 14) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = plain;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
  } else if constexpr (count == 15) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o] = plain;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o);
  } else if constexpr (count == 22) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v] = plain;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v);
  } else if constexpr (count == 23) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w] = plain;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w);
  } else if constexpr (count == 25) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y] = plain;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y);
  } else {
    static_assert(count == 0, "add a line for so many members");
  }
}

}  // namespace hagfish
