#include "core/knot/knot.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/knot/colouring.hpp"
#include "core/knot/diagram.hpp"

namespace hagfish {
namespace {

/// Two crossings that a Reidemeister move removes; move I gives the same one twice.
std::optional<std::pair<int, int>> removable(const Diagram& diagram) {
  const auto& passages = diagram.passages;
  const int count = static_cast<int>(passages.size());
  std::vector<int> under_at(diagram.sign.size());
  for (int k = 0; k < count; ++k) {
    if (!passages[k].over) under_at[passages[k].crossing] = k;
  }
  for (int k = 0; k < count; ++k) {
    const Passage& here = passages[k];
    const Passage& next = passages[(k + 1) % count];
    if (here.crossing == next.crossing) return std::pair(here.crossing, here.crossing);
    // Move II: two arcs without further crossings between the same two crossings. Opposite signs
    // make them bound an empty disc of the sphere: the four other ends lie on one side of it, and
    // the rest of the curve connects them.
    if (!here.over || !next.over) continue;
    const int apart = std::abs(under_at[here.crossing] - under_at[next.crossing]);
    if ((apart == 1 || apart == count - 1) &&
        diagram.sign[here.crossing] != diagram.sign[next.crossing]) {
      return std::pair(here.crossing, next.crossing);
    }
  }
  return std::nullopt;
}

/// Reidemeister moves I and II until none is left: a wobbly body crosses itself many times.
void reduce(Diagram& diagram) {
  while (const auto pair = removable(diagram)) {
    std::erase_if(diagram.passages, [&](const Passage& passage) {
      return passage.crossing == pair->first || passage.crossing == pair->second;
    });
  }
}

/// |det| of the colouring minor, exactly. It is a signed count of the spanning trees of the
/// diagram's checkerboard graph, which has one edge per crossing, so |det| <= 2^crossings. Enough
/// primes to span that range, all with the same residue of least size, leave one integer. Nothing
/// where that takes more than 119 crossings or is beyond 2^30.
std::optional<int> determinant_of(const Diagram& diagram) {
  constexpr std::array<std::int64_t, 4> primes = {2147483647, 2147483629, 2147483587, 2147483579};
  constexpr std::size_t bits = 30;  // of range per prime, rounded down
  const std::size_t crossings = diagram.passages.size() / 2;
  if (crossings == 0) return 1;
  const std::size_t needed = crossings / bits + 1;
  if (needed > primes.size()) return std::nullopt;
  const WholeMatrix minor = colouring_minor(diagram, -1);
  const std::int64_t determinant = determinant_modulo(minor, primes[0]);
  for (std::size_t k = 1; k < needed; ++k) {
    if (determinant_modulo(minor, primes[k]) != determinant) return std::nullopt;
  }
  return static_cast<int>(std::abs(determinant));
}

/// Vassiliev invariant of order 2 (Polyak and Viro, 1994): the sum of sign x sign over pairs of
/// crossings met from a base point in the order a under, b over, a over, b under.
int v2_of(const Diagram& diagram) {
  const auto& passages = diagram.passages;
  std::vector<int> over_at(diagram.sign.size());
  std::vector<int> under_at(diagram.sign.size());
  for (std::size_t k = 0; k < passages.size(); ++k) {
    (passages[k].over ? over_at : under_at)[passages[k].crossing] = static_cast<int>(k);
  }
  int v2 = 0;
  for (const Passage& first : passages) {
    if (first.over) continue;
    const int a = first.crossing;
    for (int k = under_at[a] + 1; k < over_at[a]; ++k) {
      const int b = passages[k].crossing;
      if (passages[k].over && under_at[b] > over_at[a]) v2 += diagram.sign[a] * diagram.sign[b];
    }
  }
  return v2;
}

/// Nothing where the diagram is too large for its determinant.
std::optional<KnotInvariants> invariants_of(Diagram diagram) {
  reduce(diagram);
  const std::optional<int> determinant = determinant_of(diagram);
  if (!determinant) return std::nullopt;
  return KnotInvariants{.determinant = *determinant, .v2 = v2_of(diagram)};
}

/// Throws what keeps a diagram from having invariants: that it is not generic, or its size.
[[noreturn]] void throw_unseen(bool generic) {
  if (!generic) {
    throw std::domain_error("knot: the projection is degenerate or the polygon touches itself");
  }
  throw std::overflow_error("knot: more than 119 crossings, or a determinant beyond 2^30");
}

/// The type of the next closure that shows one.
KnotInvariants vote(RandomClosures& closures) {
  constexpr int draws = 100;
  bool generic = true;
  for (int draw = 0; draw < draws; ++draw) {
    Diagram diagram = closures.draw();
    generic = diagram.generic;
    if (generic) {  // and yet too large, as of a wobbly body seen end on
      if (const auto type = invariants_of(std::move(diagram))) return *type;
    }
    closures.turn();
  }
  throw_unseen(generic);
}

}  // namespace

KnotInvariants invariants_of_closed(const Eigen::Matrix3Xd& points,
                                    const Eigen::Vector3d& direction) {
  if (points.cols() < 3) throw std::invalid_argument("knot: a closed polygon needs 3 points");
  if (!points.allFinite()) throw std::invalid_argument("knot: the points are not finite");
  if (!direction.allFinite() || direction.isZero(0)) {
    throw std::invalid_argument("knot: the line of sight is zero or not finite");
  }
  Diagram diagram = diagram_of_closed(points, direction);
  const bool generic = diagram.generic;
  if (generic) {
    if (const auto type = invariants_of(std::move(diagram))) return *type;
  }
  throw_unseen(generic);
}

KnotVote knot_type(const Eigen::Matrix3Xd& centreline, const KnotSettings& settings) {
  const int votes = settings.votes;
  if (centreline.cols() < 2) throw std::invalid_argument("knot: a centreline needs 2 points");
  if (!centreline.allFinite()) throw std::invalid_argument("knot: the points are not finite");
  if (votes < 1) throw std::invalid_argument("knot: at least one vote is needed");
  Eigen::Matrix3Xd points = centreline;
  if (settings.mirror) {  // the same as mirrored directions: types are blind to mirror images
    points.row(1) *= -1;
  }
  RandomClosures closures(points, settings.seed);
  std::map<std::pair<int, int>, int> votes_for;
  int cast = 0;
  for (int most = 0; cast < votes && 2 * most <= votes; ++cast) {
    const KnotInvariants type = vote(closures);
    most = std::max(most, ++votes_for[{type.determinant, type.v2}]);
  }
  // max_element keeps the first of equals: a tie goes to the smaller determinant, then v2.
  const auto winner = std::max_element(votes_for.begin(), votes_for.end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
  return {.type = {.determinant = winner->first.first, .v2 = winner->first.second},
          .agreement = static_cast<double>(winner->second) / cast};
}

}  // namespace hagfish
