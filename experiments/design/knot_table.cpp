#include "experiments/design/knot_table.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/knot/colouring.hpp"
#include "core/knot/diagram.hpp"

namespace hagfish {
namespace {

constexpr std::int64_t prime = 2147483647;
constexpr std::int64_t variable = 1234567891;  // of both polynomials: any number
constexpr std::size_t most_states = 50000;

std::int64_t power(std::int64_t base, std::int64_t exponent) {
  std::int64_t result = 1;
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result = result * base % prime;
    base = base * base % prime;
  }
  return result;
}

std::int64_t inverse(std::int64_t value) { return inverse_modulo(value, prime); }

/// How the loose ends are joined in what has been smoothed: pairs of arcs, sorted.
using Joints = std::vector<std::pair<int, int>>;

/// Takes the end that is joined to `arc` out of `joints`; `arc` itself where it is new.
int taken(Joints& joints, int arc) {
  const auto found = std::ranges::find_if(
      joints, [arc](const auto& joint) { return joint.first == arc || joint.second == arc; });
  if (found == joints.end()) return arc;
  const int other = found->first == arc ? found->second : found->first;
  joints.erase(found);
  return other;
}

/// Joins two arcs. Whether that closes a circle.
bool join(Joints& joints, int a, int b) {
  if (a == b) return true;
  const int end = taken(joints, a);
  if (end == b) return true;
  const int other = taken(joints, b);
  joints.emplace_back(std::min(end, other), std::max(end, other));
  return false;
}

/// The arcs at a crossing: before and after it along the knot, at each of its two passages.
struct Ends {
  int in[2] = {0, 0}, out[2] = {0, 0};
};

std::vector<Ends> ends_of(const Diagram& diagram) {
  std::vector<Ends> ends(diagram.sign.size());
  std::vector<int> seen(diagram.sign.size(), 0);
  const int count = static_cast<int>(diagram.passages.size());
  for (int k = 0; k < count; ++k) {
    const int crossing = diagram.passages[k].crossing;
    const int which = seen[crossing]++;
    ends[crossing].in[which] = (k + count - 1) % count;
    ends[crossing].out[which] = k;
  }
  return ends;
}

/// Crossings in an order in which few ends are loose in between.
std::vector<int> order_of(const std::vector<Ends>& ends, std::size_t arcs) {
  std::vector<int> order;
  std::vector<int> touched(arcs, 0);
  std::vector<bool> done(ends.size(), false);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    int best = -1, most = -1;
    for (std::size_t c = 0; c < ends.size(); ++c) {
      if (done[c]) continue;
      const Ends& e = ends[c];
      const int known = touched[e.in[0]] + touched[e.in[1]] + touched[e.out[0]] + touched[e.out[1]];
      if (known > most) {
        most = known;
        best = static_cast<int>(c);
      }
    }
    done[best] = true;
    order.push_back(best);
    for (const int side : {0, 1}) {
      touched[ends[best].in[side]] = 1;
      touched[ends[best].out[side]] = 1;
    }
  }
  return order;
}

/// The Jones polynomial at A^-4, with A = a.
std::int64_t jones_at(const Diagram& diagram, std::int64_t a) {
  const std::int64_t back = inverse(a);
  const std::int64_t circle = (2 * prime - power(a, 2) - power(back, 2)) % prime;
  const std::vector<Ends> ends = ends_of(diagram);
  std::map<Joints, std::int64_t> states = {{{}, 1}};
  int twists = 0;
  for (const int crossing : order_of(ends, diagram.passages.size())) {
    const Ends& e = ends[crossing];
    const bool positive = diagram.sign[crossing] > 0;
    twists += diagram.sign[crossing];
    std::map<Joints, std::int64_t> next;
    for (const auto& [before, weight] : states) {
      // Clang 14 takes bindings by name alone.
      const auto smooth = [&, &before = before, &weight = weight](int a1, int b1, int a2, int b2,
                                                                  std::int64_t factor) {
        Joints joints = before;
        std::int64_t value = weight * factor % prime;
        for (const auto& [from, to] : {std::pair(a1, b1), std::pair(a2, b2)}) {
          if (join(joints, from, to)) value = value * circle % prime;
        }
        std::ranges::sort(joints);
        std::int64_t& sum = next[joints];
        sum = (sum + value) % prime;
      };
      smooth(e.in[0], e.out[1], e.in[1], e.out[0], positive ? a : back);
      smooth(e.in[0], e.in[1], e.out[0], e.out[1], positive ? back : a);
    }
    states = std::move(next);
    if (states.size() > most_states) throw std::overflow_error("knot: too tangled a diagram");
  }
  // The bracket of a circle counts as 1; (-A^3)^-twists undoes its twists.
  const std::int64_t bracket = ends.empty() ? 1 : states.at({}) * inverse(circle) % prime;
  const std::int64_t twist = prime - power(twists > 0 ? back : a, 3);
  return bracket * power(twist, std::abs(twists)) % prime;
}

/// The Alexander polynomial at `t`, modulo the prime, times + or - a power of t.
std::int64_t alexander_at(const Diagram& diagram, std::int64_t t) {
  if (diagram.passages.empty()) return 1;
  return determinant_modulo(colouring_minor(diagram, t), prime);
}

JonesValues image_of(const JonesValues& jones) { return {jones.image, jones.knot}; }

JonesValues composite(const JonesValues& a, const JonesValues& b) {
  return {a.knot * b.knot % prime, a.image * b.image % prime};
}

KnotInvariants composite(const KnotInvariants& a, const KnotInvariants& b) {
  return {.determinant = a.determinant * b.determinant, .v2 = a.v2 + b.v2};
}

/// The crossings of a closed braid in the order of the knot.
Diagram diagram_of_braid(const std::vector<int>& word) {
  Diagram diagram;
  for (const int letter : word) diagram.sign.push_back(letter > 0 ? 1 : -1);
  int strand = 0;
  do {
    for (std::size_t k = 0; k < word.size(); ++k) {
      const int lower = std::abs(word[k]) - 1;
      if (strand != lower && strand != lower + 1) continue;
      const bool over = (strand == lower) == (word[k] > 0);
      diagram.passages.push_back(
          {static_cast<int>(diagram.passages.size()), 0, static_cast<int>(k), over});
      strand = 2 * lower + 1 - strand;
    }
  } while (strand != 0);
  return diagram;
}

KnotFingerprint composite(const KnotFingerprint& a, const KnotFingerprint& b, bool image) {
  return {composite(a.type, b.type), composite(a.jones, image ? image_of(b.jones) : b.jones),
          a.alexander * b.alexander % prime};
}

/// Of all knots of the table, in its order.
const std::vector<KnotFingerprint>& table_fingerprints() {
  static const std::vector<KnotFingerprint> values = [] {
    std::vector<KnotFingerprint> made;
    for (const TableKnot& knot : table_knots()) {
      const Diagram diagram = diagram_of_braid(knot.braid);
      made.push_back({knot.type, jones_of(diagram), alexander_of(diagram)});
    }
    return made;
  }();
  return values;
}

std::optional<KnotFingerprint> prime_called(std::string_view name) {
  if (name == "0_1") return KnotFingerprint{};
  const std::span<const TableKnot> table = table_knots();
  const auto found = std::ranges::find(table, name, &TableKnot::name);
  if (found == table.end()) return std::nullopt;
  return table_fingerprints()[found - table.begin()];
}

/// The name of a type, if the table or a composite of two of its knots has it.
std::optional<std::string> name_of(const KnotFingerprint& seen) {
  if (seen.same_but_for_image({})) return "0_1";
  const std::span<const TableKnot> table = table_knots();
  const std::vector<KnotFingerprint>& prints = table_fingerprints();
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (prints[k].same_but_for_image(seen)) return table[k].name;
  }
  for (std::size_t k = 0; k < table.size(); ++k) {
    for (std::size_t l = k; l < table.size(); ++l) {
      for (const bool image : {false, true}) {
        if (composite(prints[k], prints[l], image).same_but_for_image(seen)) {
          return std::string(table[k].name) + (image ? "#-" : "#") + table[l].name;
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace

bool JonesValues::same_but_for_image(const JonesValues& other) const {
  return (knot == other.knot && image == other.image) ||
         (knot == other.image && image == other.knot);
}

bool KnotFingerprint::same_but_for_image(const KnotFingerprint& other) const {
  return type == other.type && alexander == other.alexander &&
         jones.same_but_for_image(other.jones);
}

std::int64_t alexander_of(const Diagram& diagram) {
  // Of the two, as many powers of the variable and as many signs cancel.
  const std::int64_t product =
      alexander_at(diagram, variable) * alexander_at(diagram, inverse(variable)) % prime;
  return product < 0 ? product + prime : product;
}

JonesValues jones_of(const Diagram& diagram) {
  return {jones_at(diagram, variable), jones_at(diagram, inverse(variable))};
}

std::span<const TableKnot> table_knots() {
  static const auto table = std::to_array<TableKnot>({
      {"3_1", {3, 1}, {1, 1, 1}},
      {"4_1", {5, -1}, {1, -2, 1, -2}},
      {"5_1", {5, 3}, {1, 1, 1, 1, 1}},
      {"5_2", {7, 2}, {1, 1, 1, 2, -1, 2}},
      {"6_1", {9, -2}, {1, 1, 2, -1, -3, 2, -3}},
      {"6_2", {11, -1}, {-1, -1, -1, 2, -1, 2}},
      {"6_3", {13, 1}, {-1, -1, 2, -1, 2, 2}},
      {"7_1", {7, 6}, {1, 1, 1, 1, 1, 1, 1}},
      {"7_2", {11, 3}, {-1, -1, -1, -2, 1, -2, -3, 2, -3}},
      {"7_3", {13, 5}, {1, 1, 1, 1, 1, 2, -1, 2}},
      {"7_4", {15, 4}, {1, 1, 2, -1, 2, 2, 3, -2, 3}},
      {"7_5", {17, 4}, {-1, -1, -1, -1, -2, 1, -2, -2}},
      {"7_6", {19, 1}, {-1, -1, 2, -1, -3, 2, -3}},
      {"7_7", {21, -1}, {1, -2, 1, -2, 3, -2, 3}},
      {"8_1", {13, -3}, {-1, -1, -2, 1, -2, -3, 2, 4, -3, 4}},
      {"8_2", {17, 0}, {-1, -1, -1, -1, -1, 2, -1, 2}},
      {"8_3", {17, -4}, {1, 1, 2, -1, -3, 2, -3, -4, 3, -4}},
      {"8_4", {19, -3}, {-1, -1, -1, 2, -1, 2, 3, -2, 3}},
      {"8_5", {21, -1}, {-1, -1, -1, 2, -1, -1, -1, 2}},
      {"8_6", {23, -2}, {-1, -1, -1, -1, -2, 1, 3, -2, 3}},
      {"8_7", {23, 2}, {1, 1, 1, 1, -2, 1, -2, -2}},
      {"8_8", {25, 2}, {1, 1, 1, 2, -1, -3, 2, -3, -3}},
      {"8_9", {25, -2}, {1, 1, 1, -2, 1, -2, -2, -2}},
      {"8_10", {27, 3}, {1, 1, 1, -2, 1, 1, -2, -2}},
      {"8_11", {27, -1}, {-1, -1, -2, 1, -2, -2, 3, -2, 3}},
      {"8_12", {29, -3}, {-1, 2, -1, -3, 2, 4, -3, 4}},
      {"8_13", {29, 1}, {-1, -1, 2, -1, 2, 2, 3, -2, 3}},
      {"8_14", {31, 0}, {-1, -1, -1, -2, 1, -2, 3, -2, 3}},
      {"8_15", {33, 4}, {1, 1, -2, 1, 3, 2, 2, 2, 3}},
      {"8_16", {35, 1}, {-1, -1, 2, -1, -1, 2, -1, 2}},
      {"8_17", {37, -1}, {-1, -1, 2, -1, 2, -1, 2, 2}},
      {"8_18", {45, 1}, {-1, 2, -1, 2, -1, 2, -1, 2}},
      {"8_19", {3, 5}, {1, 1, 1, 2, 1, 1, 1, 2}},
      {"8_20", {9, 2}, {1, 1, 1, -2, -1, -1, -1, -2}},
      {"8_21", {15, 0}, {1, 1, 1, 2, -1, -1, 2, 2}},
  });
  return table;
}

std::optional<KnotFingerprint> fingerprint_called(std::string_view name) {
  const std::size_t sum = name.find('#');
  if (sum == name.npos) return prime_called(name);
  const std::optional<KnotFingerprint> first = prime_called(name.substr(0, sum));
  std::string_view rest = name.substr(sum + 1);
  const bool image = rest.starts_with('-');
  if (image) rest.remove_prefix(1);
  const std::optional<KnotFingerprint> second = prime_called(rest);
  if (!first || !second) return std::nullopt;
  return composite(*first, *second, image);
}

std::string full_knot_name(const Eigen::Matrix3Xd& centreline, const KnotSettings& settings) {
  const KnotInvariants type = knot_type(centreline, settings).type;
  RandomClosures closures(centreline, settings.seed);
  std::map<std::string, int> votes;
  for (int vote = 0; vote < settings.votes; ++vote) {
    const Diagram diagram = closures.draw();
    closures.turn();  // may be too tangled as it is seen
    if (!diagram.generic) continue;
    try {
      const std::optional<std::string> name =
          name_of({type, jones_of(diagram), alexander_of(diagram)});
      if (name) ++votes[*name];
    } catch (const std::overflow_error&) {  // too tangled as it is seen: one vote less
    }
  }
  const auto most = std::ranges::max_element(votes, {}, [](const auto& v) { return v.second; });
  return most == votes.end() ? invariants_text(type) : most->first;
}

bool is_knot(const std::string& name, const Eigen::Matrix3Xd& centreline,
             const KnotSettings& settings) {
  const std::optional<KnotFingerprint> wanted = fingerprint_called(name);
  if (!wanted) return knot_called(name) == knot_type(centreline, settings).type;
  // Of a composite there are several names.
  const auto seen = fingerprint_called(full_knot_name(centreline, settings));
  return seen && seen->same_but_for_image(*wanted);
}

}  // namespace hagfish
