// A virtual bend test: a piece of the model is bent to and fro as Long et al. (2002) bent pieces of
// hagfish, and gives back the stiffness and the ratio of stiffness to damping of the specimen file.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/chain/dynamics.hpp"
#include "experiments/common/scene_argument.hpp"

namespace hagfish::bend_test_test {

/// What a sinusoidal bend of a segment shows, dyn cm^2.
struct BendTest {
  double stiffness = 0;  ///< moment in phase with the curvature, over it
  double damping = 0;    ///< moment a quarter of a period ahead, over it
};

/// Bends the body from `from` to `to` (shares of its length) about an axis as
/// curvature sin(omega t), slowly enough for inertia not to matter, and reads the moment at the
/// segment's ends, which all its hinges carry, over one period.
BendTest bend(const Model& model, Axis axis, double from, double to, double curvature,
              double omega) {
  const int n = model.body_count();
  constexpr int samples = 64;
  BendTest result;
  for (int i = 0; i < samples; ++i) {
    const double phase = 2 * std::numbers::pi * i / samples;
    Eigen::VectorXd q = rest_state(model).q;
    Eigen::VectorXd qdot = Eigen::VectorXd::Zero(model.nv());
    double angle = 0;
    std::vector<int> bent;
    for (int k = root_dofs; k < model.nv(); ++k) {
      const Hinge& hinge = model.hinges[k - root_dofs];
      const double place = static_cast<double>(hinge.body) / n;
      if (hinge.axis != axis || place < from || place > to) continue;
      const double span = hinge_span(model, hinge.body);
      q[k + 1] = span * curvature * std::sin(phase);
      qdot[k] = span * curvature * omega * std::cos(phase);
      angle += span;
      bent.push_back(k);
    }
    EXPECT_GE(bent.size(), 2U);
    const Eigen::VectorXd elastic = stiffness_force(model, q);
    // What a step takes for damping: the linear part in h of H's diagonal.
    const double h = 1e-6;
    const State state{q, qdot};
    const Kinematics kin = kinematics(model, state);
    const Eigen::VectorXd diagonal = step_system(model, state, kin, {}, h).op.diagonal;
    double moment = 0;  // mean of the hinges', on the test machine
    for (const int k : bent) {
      const Hinge& hinge = model.hinges[k - root_dofs];
      const double damping = (diagonal[k] - h * h * hinge.stiffness) / h;
      moment += (-elastic[k] + damping * qdot[k]) / static_cast<double>(bent.size());
    }
    result.stiffness += 2.0 / samples * moment * std::sin(phase) / curvature;
    result.damping += 2.0 / samples * moment * std::cos(phase) / curvature;
  }
  return result;
}

TEST(VirtualBendTest, GivesBackTheSpecimensStiffnessAndDamping) {
  for (const char* bodies : {"100", "200"}) {
    const Model model =
        scene_argument("living_overhand", {std::string("model.bodies=") + bodies}).model;
    // 2.5 cm about 37 % of the length, 20 per m, 3 pi rad/s: the middle of what was tested.
    const double omega = 3 * std::numbers::pi;
    for (const Axis axis : {Axis::y, Axis::z}) {
      const BendTest test = bend(model, axis, 0.34, 0.4, 0.2, omega);
      // The profile is even, so that all hinges carry the same moment: rounding.
      EXPECT_NEAR(test.stiffness, 2e5, 1e-6 * 2e5);
      // EI / 7 at that frequency, to the two digits that the specimen file gives.
      EXPECT_NEAR(test.stiffness / test.damping, 7, 0.1);
    }
    const BendTest twist = bend(model, Axis::x, 0.34, 0.4, 0.05, omega);
    EXPECT_NEAR(twist.stiffness, 1.3e5, 1e-6 * 1.3e5);
    EXPECT_NEAR(twist.stiffness / twist.damping, 7, 0.15);
  }
}

}  // namespace hagfish::bend_test_test
