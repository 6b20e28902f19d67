#include "core/knot/knot.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

namespace hagfish {
namespace {

/// Lengths below this share of the polygon's radius count as degenerate. Edges whose ends are all
/// farther than that from each other's line cross at a sine of at least as much, and then the place
/// of the crossing is rounded by less than a fifth of it: no decision made depends on rounding.
constexpr double generic = 1e-7;

/// Where two edges of the projection cross.
struct Meeting {
  double at_first, at_second;  ///< from the edge's start, projected length
  bool first_over;
  int sign;  ///< +1 where the over strand turns anticlockwise into the under strand
};

/// One of the two visits of the polygon to a crossing.
struct Passage {
  int edge;
  double at;  ///< from the edge's start, projected length
  int crossing;
  bool over;
};

/// Signed Gauss code. Passages are in the order of the polygon; each crossing left has two.
struct Diagram {
  std::vector<Passage> passages;
  std::vector<int> sign;  ///< by crossing, whether left or not
};

/// Bounding rectangles of the projected edges.
struct Boxes {
  Eigen::ArrayXd left, right, bottom, top;
};

[[noreturn]] void throw_degenerate() {
  throw std::domain_error("knot: the projection is degenerate or the polygon touches itself");
}

double cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Coordinates (3 x n) about the mean, the third one pointing at the observer.
Eigen::Matrix3Xd seen_along(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& direction) {
  Eigen::Matrix3d axes;
  axes.col(2) = direction.normalized();
  axes.col(0) = axes.col(2).unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes.transpose() * (points.colwise() - points.rowwise().mean());
}

/// Where edge a-b crosses edge c-d in projection, if it does. Throws where `tolerance` cannot tell.
std::optional<Meeting> meet(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c, const Eigen::Vector3d& d, double tolerance) {
  const Eigen::Vector3d first = b - a;
  const Eigen::Vector3d second = d - c;
  const double first_length = first.head<2>().norm();
  const double second_length = second.head<2>().norm();
  // Distances from the line through the other edge. A side is decided beyond the tolerance only.
  const double to_c = cross(first, c - a) / first_length;
  const double to_d = cross(first, d - a) / first_length;
  if (std::min(to_c, to_d) > tolerance || std::max(to_c, to_d) < -tolerance) return std::nullopt;
  const double to_a = cross(second, a - c) / second_length;
  const double to_b = cross(second, b - c) / second_length;
  if (std::min(to_a, to_b) > tolerance || std::max(to_a, to_b) < -tolerance) return std::nullopt;

  const double nearest = std::min({std::abs(to_a), std::abs(to_b), std::abs(to_c), std::abs(to_d)});
  const double turn = cross(first, second);
  // The sign of this volume tells over from under without the place of the crossing.
  const double volume = first.cross(second).dot(c - a);
  // Written so that the nan of an edge seen end on is degenerate too.
  const bool decided =
      nearest > tolerance && std::abs(volume) > tolerance * first.norm() * second.norm();
  if (!decided) throw_degenerate();

  return Meeting{.at_first = first_length * to_a / (to_a - to_b),
                 .at_second = second_length * to_c / (to_c - to_d),
                 .first_over = (volume > 0) != (turn > 0),
                 .sign = volume > 0 ? -1 : 1};
}

Boxes boxes_of_edges(const Eigen::Matrix3Xd& view) {
  const Eigen::Index count = view.cols();
  Eigen::ArrayX2d ends(count + 1, 2);
  ends.topRows(count) = view.topRows<2>().transpose();
  ends.row(count) = ends.row(0);
  const auto from = ends.topRows(count);
  const auto to = ends.bottomRows(count);
  return {from.col(0).min(to.col(0)), from.col(0).max(to.col(0)), from.col(1).min(to.col(1)),
          from.col(1).max(to.col(1))};
}

/// Diagram of the closed polygon `view` (3 x n) seen along its third axis.
Diagram project(const Eigen::Matrix3Xd& view) {
  const int count = static_cast<int>(view.cols());
  const double tolerance = generic * view.colwise().norm().maxCoeff();
  const Boxes boxes = boxes_of_edges(view);
  constexpr int batch = 8;  // edges tested together: few cross
  Eigen::ArrayXd apart =
      Eigen::ArrayXd::Constant(count + batch, std::numeric_limits<double>::infinity());
  std::vector<int> near;
  Diagram diagram;
  for (int i = 0; i + 2 < count; ++i) {
    const int end = i == 0 ? count - 1 : count;  // the last edge ends where the first one starts
    const auto later = Eigen::seq(i + 2, end - 1);
    apart(later) = (boxes.left(later) - boxes.right[i])
                       .max(boxes.left[i] - boxes.right(later))
                       .max(boxes.bottom(later) - boxes.top[i])
                       .max(boxes.bottom[i] - boxes.top(later));
    near.clear();
    for (int first = i + 2; first < end; first += batch) {
      if (apart.segment<batch>(first).minCoeff() <= tolerance) {
        for (int j = first; j < std::min(first + batch, end); ++j) {
          if (apart[j] <= tolerance) near.push_back(j);
        }
      }
    }
    for (const int j : near) {
      const auto meeting =
          meet(view.col(i), view.col(i + 1), view.col(j), view.col((j + 1) % count), tolerance);
      if (!meeting) continue;
      const int crossing = static_cast<int>(diagram.sign.size());
      diagram.sign.push_back(meeting->sign);
      diagram.passages.push_back({i, meeting->at_first, crossing, meeting->first_over});
      diagram.passages.push_back({j, meeting->at_second, crossing, !meeting->first_over});
    }
  }

  auto& passages = diagram.passages;
  std::sort(passages.begin(), passages.end(), [](const Passage& p, const Passage& q) {
    return std::pair(p.edge, p.at) < std::pair(q.edge, q.at);
  });
  for (std::size_t k = 1; k < passages.size(); ++k) {
    if (passages[k].edge == passages[k - 1].edge &&
        passages[k].at - passages[k - 1].at <= tolerance) {
      throw_degenerate();
    }
  }
  return diagram;
}

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

/// Minor (size x size, row by row) of the colouring matrix. Arcs run from one underpass to the
/// next; each crossing says 2 over - before - after = 0. The last crossing and arc are left out.
std::vector<std::int64_t> colouring_minor(const Diagram& diagram, int size) {
  std::vector<int> arc_over(diagram.sign.size());
  int arc = 0;
  for (const Passage& passage : diagram.passages) {
    if (passage.over) {
      arc_over[passage.crossing] = arc % (size + 1);
    } else {
      ++arc;
    }
  }
  std::vector<std::int64_t> minor(size * size, 0);
  const auto add = [&](int row, int column, int value) {
    if (column < size) minor[row * size + column] += value;
  };
  int row = 0;
  for (const Passage& passage : diagram.passages) {
    if (passage.over) continue;
    if (row == size) break;
    add(row, arc_over[passage.crossing], 2);
    add(row, row, -1);
    add(row, row + 1, -1);
    ++row;
  }
  return minor;
}

std::int64_t inverse_modulo(std::int64_t value, std::int64_t prime) {
  std::int64_t result = 1;  // value^(prime - 2), by Fermat
  for (std::int64_t power = prime - 2; power > 0; power /= 2) {
    if (power % 2 == 1) result = result * value % prime;
    value = value * value % prime;
  }
  return result;
}

/// Determinant of `matrix` (size x size) modulo a prime below 2^31, between -prime/2 and prime/2.
std::int64_t determinant_modulo(std::vector<std::int64_t> matrix, int size, std::int64_t prime) {
  for (std::int64_t& entry : matrix) entry = (entry + prime) % prime;
  std::int64_t determinant = 1;
  for (int k = 0; k < size; ++k) {
    const auto row = [&](int i) { return matrix.begin() + i * size; };
    int pivot = k;
    while (pivot < size && row(pivot)[k] == 0) ++pivot;
    if (pivot == size) return 0;
    if (pivot != k) {
      std::swap_ranges(row(pivot), row(pivot) + size, row(k));
      determinant = prime - determinant;
    }
    determinant = determinant * row(k)[k] % prime;
    const std::int64_t inverse = inverse_modulo(row(k)[k], prime);
    for (int i = pivot + 1; i < size; ++i) {
      if (row(i)[k] == 0) continue;
      const std::int64_t factor = prime - row(i)[k] * inverse % prime;
      for (int j = k; j < size; ++j) row(i)[j] = (row(i)[j] + factor * row(k)[j]) % prime;
    }
  }
  return determinant > prime / 2 ? determinant - prime : determinant;
}

/// |det| of the colouring minor, exactly. It is a signed count of the spanning trees of the
/// diagram's checkerboard graph, which has one edge per crossing, so |det| <= 2^crossings. Enough
/// primes to span that range, all with the same residue of least size, leave one integer.
int determinant_of(const Diagram& diagram) {
  constexpr std::array<std::int64_t, 4> primes = {2147483647, 2147483629, 2147483587, 2147483579};
  constexpr std::size_t bits = 30;  // of range per prime, rounded down
  const std::size_t crossings = diagram.passages.size() / 2;
  if (crossings == 0) return 1;
  const std::size_t needed = crossings / bits + 1;
  if (needed > primes.size()) throw std::overflow_error("knot: more than 119 crossings");
  const int size = static_cast<int>(crossings) - 1;
  const std::vector<std::int64_t> minor = colouring_minor(diagram, size);
  const std::int64_t determinant = determinant_modulo(minor, size, primes[0]);
  for (std::size_t k = 1; k < needed; ++k) {
    if (determinant_modulo(minor, size, primes[k]) != determinant) {
      throw std::overflow_error("knot: the determinant is beyond 2^30");
    }
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

/// Uniform on the sphere, from the generator's bits alone: the same on every platform.
Eigen::Vector3d random_direction(std::mt19937& random) {
  while (true) {
    Eigen::Vector3d point;
    for (double& coordinate : point) coordinate = static_cast<double>(random()) * 0x1p-31 - 1;
    const double square = point.squaredNorm();
    if (square > 0.01 && square < 1) return point / std::sqrt(square);
  }
}

/// One vote. `closed` holds the centreline and two more columns, which this function sets.
KnotInvariants cast_vote(Eigen::Matrix3Xd& closed, double far, std::mt19937& random) {
  constexpr int draws = 100;
  const Eigen::Index count = closed.cols() - 2;
  for (int draw = 1;; ++draw) {
    const Eigen::Vector3d out = random_direction(random);
    closed.col(count) = closed.col(count - 1) + far * out;
    closed.col(count + 1) = closed.col(0) + far * out;
    try {
      return invariants_of_closed(closed, random_direction(random));
    } catch (const std::domain_error&) {
      if (draw == draws) throw;
    } catch (const std::overflow_error&) {  // as of a wobbly body seen end on
      if (draw == draws) throw;
    }
  }
}

}  // namespace

KnotInvariants invariants_of_closed(const Eigen::Matrix3Xd& points,
                                    const Eigen::Vector3d& direction) {
  if (points.cols() < 3) throw std::invalid_argument("knot: a closed polygon needs 3 points");
  if (!points.allFinite()) throw std::invalid_argument("knot: the points are not finite");
  if (!direction.allFinite() || direction.isZero(0)) {
    throw std::invalid_argument("knot: the line of sight is zero or not finite");
  }
  Diagram diagram = project(seen_along(points, direction));
  reduce(diagram);
  return {.determinant = determinant_of(diagram), .v2 = v2_of(diagram)};
}

KnotVote knot_type(const Eigen::Matrix3Xd& centreline, const KnotSettings& settings) {
  const int votes = settings.votes;
  const Eigen::Index count = centreline.cols();
  if (count < 2) throw std::invalid_argument("knot: a centreline needs 2 points");
  if (votes < 1) throw std::invalid_argument("knot: at least one vote is needed");
  Eigen::Matrix3Xd closed(3, count + 2);
  closed.leftCols(count) = centreline;
  if (settings.mirror) {  // the same as mirrored directions: types are blind to mirror images
    closed.row(1) *= -1;
  }
  // The edge that joins the ends must pass outside the ball around the centreline; more than two
  // radii away is enough, and farther would only cost precision.
  const double radius =
      (centreline.colwise() - centreline.rowwise().mean()).colwise().norm().maxCoeff();
  std::mt19937 random(settings.seed);
  std::map<std::pair<int, int>, int> ballots;
  int cast = 0;
  for (int most = 0; cast < votes && 2 * most <= votes; ++cast) {
    const KnotInvariants type = cast_vote(closed, 4 * radius, random);
    most = std::max(most, ++ballots[{type.determinant, type.v2}]);
  }
  // max_element keeps the first of equals: a tie goes to the smaller determinant, then v2.
  const auto winner = std::max_element(ballots.begin(), ballots.end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
  return {.type = {.determinant = winner->first.first, .v2 = winner->first.second},
          .agreement = static_cast<double>(winner->second) / cast};
}

}  // namespace hagfish
