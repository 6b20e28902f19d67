// Rolfsen's table to eight crossings, from closed braids laid out in space: each type and each
// composite of two small ones has its own name.
#include "experiments/design/knot_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "tests/support/knot_curves.hpp"

namespace hagfish::knot_table_test {

int strands_of(const std::vector<int>& word) {
  int strands = 1;
  for (const int letter : word) strands = std::max(strands, std::abs(letter) + 1);
  return strands;
}

Eigen::Matrix3Xd laid_out(const TableKnot& knot) {
  return braid_closure(knot.braid, strands_of(knot.braid));
}

const TableKnot& table_knot(const std::string& name) {
  for (const TableKnot& knot : table_knots()) {
    if (name == knot.name) return knot;
  }
  throw std::logic_error(name + " is not in the table");
}

/// Two braids side by side: the sum of their closures.
Eigen::Matrix3Xd sum_of(const TableKnot& a, const TableKnot& b, bool image) {
  std::vector<int> word = a.braid;
  const int shift = strands_of(a.braid) - 1;
  for (const int letter : b.braid) {
    const int moved = letter > 0 ? letter + shift : letter - shift;
    word.push_back(image ? -moved : moved);
  }
  return braid_closure(word, shift + strands_of(b.braid));
}

const Eigen::Vector3d sight(0.3, 0.4, 0.86);

TEST(KnotTable, InvariantsAreThoseOfTheBraids) {
  EXPECT_EQ(table_knots().size(), 35);
  for (const TableKnot& knot : table_knots()) {
    EXPECT_EQ(invariants_of_closed(laid_out(knot), sight), knot.type) << knot.name;
    const Diagram diagram = diagram_of_closed(laid_out(knot), sight);
    const KnotFingerprint seen{knot.type, jones_of(diagram), alexander_of(diagram)};
    EXPECT_TRUE(seen.same_but_for_image(*fingerprint_called(knot.name))) << knot.name;
  }
  for (const NamedKnot& knot : named_knots()) {
    EXPECT_EQ(fingerprint_called(knot.name)->type, knot.type) << knot.name;
  }
}

TEST(KnotTable, AllTypesAndCompositesOfTwoDiffer) {
  using Key = std::tuple<int, int, std::int64_t, std::set<std::int64_t>>;
  std::map<Key, std::string> seen;
  const auto add = [&](const std::string& name) {
    const KnotFingerprint of = *fingerprint_called(name);
    const Key key{of.type.determinant, of.type.v2, of.alexander, {of.jones.knot, of.jones.image}};
    const auto [place, is_new] = seen.emplace(key, name);
    EXPECT_TRUE(is_new) << name << " is " << place->second;
  };
  add("0_1");
  const auto table = table_knots();
  const auto amphichiral = [](const TableKnot& knot) {
    const JonesValues jones = fingerprint_called(knot.name)->jones;
    return jones.knot == jones.image;
  };
  for (std::size_t k = 0; k < table.size(); ++k) {
    const std::string first = table[k].name;
    add(first);
    for (std::size_t l = k; l < table.size(); ++l) {
      const std::string second = table[l].name;
      add(first + "#" + second);
      if (!amphichiral(table[k]) && !amphichiral(table[l])) add(first + "#-" + second);
    }
  }
}

TEST(KnotTable, OpenPolygonsHaveTheirFullNames) {
  const KnotSettings settings{.votes = 5, .seed = 3};
  for (const char* name : {"3_1", "5_2", "7_7", "8_19", "8_20", "8_21"}) {
    EXPECT_EQ(full_knot_name(opened(laid_out(table_knot(name))), settings), name);
  }
  const TableKnot &trefoil = table_knot("3_1"), &eight = table_knot("4_1");
  EXPECT_EQ(full_knot_name(opened(sum_of(trefoil, trefoil, false)), settings), "3_1#3_1");
  EXPECT_EQ(full_knot_name(opened(sum_of(trefoil, trefoil, true)), settings), "3_1#-3_1");
  EXPECT_EQ(full_knot_name(opened(sum_of(trefoil, eight, false)), settings), "3_1#4_1");
  EXPECT_TRUE(is_knot("4_1#3_1", opened(sum_of(trefoil, eight, false)), settings));
  EXPECT_TRUE(is_knot("det=9,v2=2", opened(sum_of(trefoil, trefoil, true)), settings));
  EXPECT_FALSE(is_knot("3_1#3_1", opened(sum_of(trefoil, trefoil, true)), settings));
  EXPECT_FALSE(is_knot("det=9,v2=3", opened(sum_of(trefoil, trefoil, true)), settings));
  EXPECT_EQ(full_knot_name(opened(torus_knot(9)), settings), "det=9,v2=10");
}

TEST(KnotTable, UnknownNamesAreNone) {
  for (const char* name : {"", "3_2", "8_22", "#3_1", "3_1#", "3_1##3_1", "3_1#3_1#3_1", "-3_1"}) {
    EXPECT_FALSE(fingerprint_called(name)) << name;
  }
}

}  // namespace hagfish::knot_table_test
