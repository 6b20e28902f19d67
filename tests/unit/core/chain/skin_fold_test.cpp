// Radius of the skin over radius of curvature, on bends of known curvature.
#include "core/chain/skin_fold.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_chain.hpp"

namespace hagfish::skin_fold_test {

/// The animal with bending joints turned so that its curvature is `along(s)`, 1/cm, s cm from the
/// head.
template <class Along>
double fold_of(int bodies, Along along) {
  const Model model = table1_hagfish(bodies);
  State state = rest_state(model);
  double arc = 0;
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    for (int k = body.first_dof; body.dofs == 2 && k < body.first_dof + 2; ++k) {
      const bool about_y = model.hinges[k - root_dofs].axis == Axis::y;
      if (about_y) state.q[k + 1] = along(arc) * hinge_span(model, b);
    }
    arc += body.length;
  }
  return skin_fold(model, kinematics(model, state));
}

double widest(int bodies) {
  double most = 0;
  for (const Body& body : table1_hagfish(bodies).bodies) most = std::max(most, body.radius);
  return most;
}

TEST(SkinFold, IsRadiusOverRadiusOfCurvatureOnACircle) {
  EXPECT_EQ(fold_of(100, [](double) { return 0.0; }), 0);
  for (const int bodies : {60, 100, 101, 200}) {
    for (const double curvature : {0.1, 0.5, 1.0}) {
      // Straight from tangent to tangent, of which the largest turn between two makes the error.
      const double turn = curvature * 2 * 42.4 / bodies;
      // The first and the last joint stand for more of the body than lies between joints.
      const auto circle = [=](double s) { return s > 4 && s < 38 ? curvature : 0; };
      EXPECT_NEAR(fold_of(bodies, circle), widest(bodies) * curvature,
                  0.02 * curvature + 0.06 * turn * turn)
          << bodies << " bodies, " << curvature;
    }
  }
}

// A bend whose curvature rises and falls within three diameters.
TEST(SkinFold, HardlyDependsOnTheMesh) {
  const auto bump = [](double s) { return 1.2 * std::exp(-std::pow((s - 20) / 1.5, 2)); };
  const double fine = fold_of(400, bump);
  EXPECT_NEAR(fold_of(100, bump), fine, 0.05 * fine);
  EXPECT_NEAR(fold_of(200, bump), fine, 0.02 * fine);
}

TEST(SkinFold, IsOfTheTurnInSpace) {
  // There and back within one diameter is no bend of the body.
  const auto to_and_fro = [](double s) { return std::fmod(s, 1.696) < 0.848 ? 0.5 : -0.5; };
  EXPECT_LT(fold_of(100, to_and_fro), 0.5 * fold_of(100, [](double) { return 0.5; }));
}

}  // namespace hagfish::skin_fold_test
