// Linear interpolation in a table: exact at knots, constant outside of them.
#include "core/scene/interpolation.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hagfish::interpolation_test {

TEST(Interpolation, IsLinearBetweenKnotsAndConstantOutside) {
  const std::vector<double> knots{1, 2, 4}, values{5, 3, 4};
  const auto value = [&](double x) {
    return value_at(bracket_of(knots, x), [&](std::size_t k) { return values[k]; });
  };
  EXPECT_EQ(value(-7), 5);
  EXPECT_EQ(value(1), 5);
  EXPECT_EQ(value(1.75), 3.5);
  EXPECT_EQ(value(2), 3);
  EXPECT_EQ(value(3), 3.5);
  EXPECT_EQ(value(4), 4);
  EXPECT_EQ(value(9), 4);
}

TEST(Interpolation, TakesOneKnotAndKnotsWithMore) {
  struct Knot {
    double time;
  };
  const std::vector<Knot> one{{3}}, two{{3}, {5}};
  for (const double x : {2.0, 3.0, 4.0}) {
    const Bracket place = bracket_of(one, x, &Knot::time);
    EXPECT_EQ(place.index, 0u);
    EXPECT_EQ(place.share, 0);  // no other value is asked for
  }
  EXPECT_EQ(bracket_of(two, 4.5, &Knot::time).share, 0.75);
  EXPECT_EQ(bracket_of(two, 5, &Knot::time).index, 1u);
}

}  // namespace hagfish::interpolation_test
