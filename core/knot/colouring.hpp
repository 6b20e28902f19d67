// The matrix of a diagram whose determinant is its Alexander polynomial, and determinants modulo a
// prime.
#pragma once

#include <cstdint>
#include <vector>

#include "core/knot/diagram.hpp"

namespace hagfish {

/// A square matrix of whole numbers.
struct WholeMatrix {
  int size = 0;
  std::vector<std::int64_t> entries;  ///< row by row
};

/// Minor of the matrix whose determinant is the Alexander polynomial at `t`, times + or - a power
/// of t. Arcs run from one underpass to the next. A crossing says (1 - t) over + t one - other = 0
/// of the arcs that meet under it (Fox's calculus; at -1 the colouring matrix). The last crossing
/// and arc are left out. `diagram` has at least one crossing.
WholeMatrix colouring_minor(const Diagram& diagram, std::int64_t t);

/// The inverse of `value` modulo `prime`, for 0 < value < prime.
std::int64_t inverse_modulo(std::int64_t value, std::int64_t prime);

/// Determinant of `matrix`, with entries between -prime and prime, modulo a prime below 2^31:
/// between -prime/2 and prime/2.
std::int64_t determinant_modulo(WholeMatrix matrix, std::int64_t prime);

}  // namespace hagfish
