// Knot types told apart as far as Rolfsen's table to eight crossings and the composites of two of
// these need it: by the invariants of knot.hpp, the Jones polynomial and the Alexander polynomial,
// each at one number. That takes longer, so that a controller does not ask for it at each look.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/knot/diagram.hpp"
#include "core/knot/knot.hpp"

namespace hagfish {

/// Values of the Jones polynomial of a knot and of its mirror image at one number, modulo 2^31 - 1.
struct JonesValues {
  std::int64_t knot = 1, image = 1;
  /// Whether both are of one knot, or of one and the other's mirror image.
  bool same_but_for_image(const JonesValues& other) const;
};

/// Values of the knot of a diagram, by smoothing one crossing after the other (Kauffman's bracket).
/// Throws std::overflow_error where that leaves too many ways in which loose ends are joined.
JonesValues jones_of(const Diagram& diagram);

/// A prime knot as a closed braid: k crosses the k-th strand (from 1) with the next one, -k the
/// other way.
struct TableKnot {
  const char* name;
  KnotInvariants type;
  std::vector<int> braid;
};

/// Rolfsen's table from 3_1 to 8_21; of two mirror images, either.
std::span<const TableKnot> table_knots();

/// The Alexander polynomial at one number, modulo 2^31 - 1, times that at its inverse: of both
/// images, and whatever power of the variable the polynomial is taken to have as a factor.
std::int64_t alexander_of(const Diagram& diagram);

/// What tells a type from all others of the table and from composites of two, but for its image.
struct KnotFingerprint {
  KnotInvariants type;
  JonesValues jones;
  std::int64_t alexander = 1;
  bool same_but_for_image(const KnotFingerprint& other) const;
};
/// Fingerprint of "0_1", "3_1" to "8_21", or of a composite of two of these; nothing of any other
/// name. "A#B" is of A and B, "A#-B" of A and the table's mirror image of B.
std::optional<KnotFingerprint> fingerprint_called(std::string_view name);

/// The name of the open polygon's type, as knot_type() takes it; of a composite of table knots
/// "A#B" or, where images matter, "A#-B"; invariants_text() of what the table does not have. By
/// `settings.votes` closures. Throws as knot_type.
std::string full_knot_name(const Eigen::Matrix3Xd& centreline, const KnotSettings& settings);

/// Whether the open polygon is of the type called `name` (as of fingerprint_called), or has the
/// invariants of which that is the text, but for its image. Throws as knot_type.
bool is_knot(const std::string& name, const Eigen::Matrix3Xd& centreline,
             const KnotSettings& settings);

}  // namespace hagfish
