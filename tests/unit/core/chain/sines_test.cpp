#include "core/chain/sines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/random_chain.hpp"

namespace hagfish::sines_test {

/// EXPECTs the sines and cosines of the standard library, to two units in the last place, and of
/// the opposite angles exactly the opposite and the same.
void expect_sines_and_cosines(const Eigen::VectorXd& angles) {
  constexpr double rounding = 4.5e-16;
  Eigen::VectorXd sine, cosine, sine_of_opposite, cosine_of_opposite;
  sines_and_cosines(angles, sine, cosine);
  sines_and_cosines(-angles, sine_of_opposite, cosine_of_opposite);
  ASSERT_EQ(sine.size(), angles.size());
  ASSERT_EQ(cosine.size(), angles.size());
  EXPECT_EQ(sine_of_opposite, -sine);
  EXPECT_EQ(cosine_of_opposite, cosine);
  for (Eigen::Index k = 0; k < angles.size(); ++k) {
    const double s = std::sin(angles[k]), c = std::cos(angles[k]);
    EXPECT_NEAR(sine[k], s, rounding * std::abs(s)) << angles[k];
    EXPECT_NEAR(cosine[k], c, rounding * std::abs(c)) << angles[k];
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

TEST(Sines, PlainOnesAreThoseOfTheStandardLibrary) {
  constexpr double rounding = 4.5e-16;
  Random random(7);
  for (const double size : {1e-9, 0.1, 1.0, 4.0, 100.0, 9e5, 1e9}) {
    for (const double angle : random_entries(random, 2000, size)) {
      const auto [sine, cosine] = plain_sine_and_cosine(angle);
      const SineCosine opposite = plain_sine_and_cosine(-angle);
      EXPECT_EQ(opposite.sine, -sine);
      EXPECT_EQ(opposite.cosine, cosine);
      const double s = std::sin(angle), c = std::cos(angle);
      EXPECT_NEAR(sine, s, rounding * std::abs(s)) << angle;
      EXPECT_NEAR(cosine, c, rounding * std::abs(c)) << angle;
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
