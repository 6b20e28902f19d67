// Knot type of an open centreline by topological invariants.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/scene/settings.hpp"

namespace hagfish {

/// Invariants of a knot type, blind to mirror images. (1, 0) unknot, (3, 1) 3_1, (5, -1) 4_1,
/// (5, 3) 5_1, (7, 2) 5_2. Larger knots can share them: 10_132 has those of 5_1.
struct KnotInvariants {
  int determinant = 1;  ///< |Alexander polynomial at -1|, odd
  int v2 = 0;           ///< Vassiliev invariant of order 2; even just where determinant = +-1 mod 8
  bool operator==(const KnotInvariants&) const = default;
};

struct KnotVote {
  KnotInvariants type;   ///< the most frequent answer
  double agreement = 1;  ///< its share of the votes cast, above 0 and up to 1
};

/// Invariants of the closed polygon through the columns of `points` (3 x n, n >= 3, any length
/// unit), the last joined to the first. `direction` is the line of sight, of any length; it must be
/// generic (no vertex hides another exactly).
/// Throws std::domain_error where it is not generic to 1e-7 of the polygon's size, and so always
/// where the polygon touches itself or repeats a vertex; std::overflow_error for a determinant
/// beyond 2^30 or 120 crossings that Reidemeister moves I and II do not remove;
/// std::invalid_argument for too few or non-finite points and for a zero direction.
KnotInvariants invariants_of_closed(const Eigen::Matrix3Xd& points,
                                    const Eigen::Vector3d& direction);

/// Type of the open polygon through the columns of `centreline` (3 x n, n >= 2, any length unit).
/// Both ends are extended in one direction beyond a sphere around the polygon and joined there,
/// for up to settings.votes >= 1 directions drawn from settings.seed; each gives one vote, until
/// more than half of them all agree. With settings.mirror the answer is, vote for vote, that of the
/// mirror image (y to -y) without it. A tie goes to the smaller
/// determinant, then the smaller v2. The directions are the same on every platform.
/// A closure or line of sight that is not generic, or shows too many crossings, is drawn again.
/// Throws as invariants_of_closed, but of these two errors only where 100 draws in a row failed:
/// the polygon touches itself, repeats a vertex or ends where it starts, or is too tangled.
KnotVote knot_type(const Eigen::Matrix3Xd& centreline, const KnotSettings& settings);

struct NamedKnot {
  const char* name;
  KnotInvariants type;
};

/// The types that have names: "0_1", none, and the prime knots of up to seven crossings.
std::span<const NamedKnot> named_knots();

/// "det=3,v2=1".
std::string invariants_text(const KnotInvariants& type);

/// "0_1", or a prime knot of up to seven crossings, "3_1" to "7_7"; for any other
/// its invariants_text().
std::string knot_name(const KnotInvariants& type);

/// The type of which `name` is the knot_name(), or nothing.
std::optional<KnotInvariants> knot_called(std::string_view name);

/// "overhand, 3_1" of a knot_name() that people have a name for, "no knot" of "0_1", else itself.
std::string knot_words(std::string_view name);
inline std::string knot_words(const KnotInvariants& type) { return knot_words(knot_name(type)); }

/// "no knot", or "a knot (overhand, 3_1)".
std::string a_knot(std::string_view name);

}  // namespace hagfish
