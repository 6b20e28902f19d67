// What commands on films say of a film.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/input/input_text.hpp"
#include "experiments/film/film.hpp"

namespace hagfish {

/// ", its animal of 35 cm scaled to 42.4 cm"; empty where the lengths are the same to 0.1 %.
inline std::string scaled(const Film& film, double scale) {
  constexpr double same = 1e-3;
  return std::abs(scale - 1) < same ? ""
                                    : fmt::format(", its animal of {:.3g} cm scaled to {:.3g} cm",
                                                  film.length, scale * film.length);
}

/// A line, of a film without z.
inline std::string flat_note(const std::string& film) {
  return fmt::format(
      "{}: has no z, so that its animal is taken to lie in a plane, which no knot does\n",
      printable(film));
}

}  // namespace hagfish
