#include "core/chain/sines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/random_chain.hpp"

namespace hagfish::sines_test {

/// EXPECTs the sines and cosines of the standard library, of many angles at once and of each alone,
/// to two units in the last place, and of the opposite angles exactly the opposite and the same.
/// Where the library has none of many at once, these are those of each alone.
void expect_sines_and_cosines(const Eigen::VectorXd& angles) {
  constexpr double rounding = 4.5e-16, of_quarter = 1e-26;
  Eigen::VectorXd sine, cosine, sine_of_opposite, cosine_of_opposite;
  sines_and_cosines(angles, sine, cosine);
  sines_and_cosines(-angles, sine_of_opposite, cosine_of_opposite);
  ASSERT_EQ(sine.size(), angles.size());
  ASSERT_EQ(cosine.size(), angles.size());
  EXPECT_EQ(sine_of_opposite, -sine);
  EXPECT_EQ(cosine_of_opposite, cosine);
  for (Eigen::Index k = 0; k < angles.size(); ++k) {
    const double s = std::sin(angles[k]), c = std::cos(angles[k]);
    const double nearly_zero = of_quarter * std::abs(angles[k]);
    const SineCosine alone = plain_sine_and_cosine(angles[k]);
    if (sine[k] != alone.sine) {
      EXPECT_NEAR(sine[k], s, rounding * std::abs(s)) << angles[k];
    }
    if (cosine[k] != alone.cosine) {
      EXPECT_NEAR(cosine[k], c, rounding * std::abs(c)) << angles[k];
    }
    const SineCosine opposite = plain_sine_and_cosine(-angles[k]);
    EXPECT_NEAR(alone.sine, s, rounding * std::abs(s) + nearly_zero) << angles[k];
    EXPECT_NEAR(alone.cosine, c, rounding * std::abs(c) + nearly_zero) << angles[k];
    EXPECT_EQ(opposite.sine, -alone.sine);
    EXPECT_EQ(opposite.cosine, alone.cosine);
  }
}

TEST(Sines, AreThoseOfTheStandardLibrary) {
  Random random(5);
  for (const double size : {1e-9, 0.1, 1.0, 4.0, 100.0, 1e6, 1e9}) {
    for (const int count : {0, 1, 3, 7, 8, 153, 2000}) {
      expect_sines_and_cosines(random_entries(random, count, size));
    }
  }
}

TEST(Sines, AreThoseWhereTheQuarterChanges) {
  for (int eighth = -80; eighth <= 80; ++eighth) {
    const double angle = eighth * std::numbers::pi / 4;
    expect_sines_and_cosines(
        Eigen::VectorXd::LinSpaced(9, angle * (1 - 4e-16), angle * (1 + 4e-16)));
  }
}

TEST(Sines, OfOneThatIsNotFiniteSpoilNoOther) {
  Eigen::VectorXd angles = Eigen::VectorXd::Constant(9, 0.7), plain, sine, cosine;
  sines_and_cosines(angles, plain, cosine);
  angles[1] = INFINITY;
  sines_and_cosines(angles, sine, cosine);
  EXPECT_TRUE(std::isnan(sine[1]) && std::isnan(cosine[1]));
  EXPECT_EQ(sine.tail(7), plain.tail(7));
}

}  // namespace hagfish::sines_test
