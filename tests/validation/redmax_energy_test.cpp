// RedMax's own reference runs (Wang et al. 2019): total energy gained after 2 s by chains of
// cuboids that fall from rest, h = 10 ms, Coriolis terms explicit, positions moved by the new
// velocity. Their energies are an exact record of the time stepping, not of the physics.
#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "tests/support/chain_runs.hpp"

namespace hagfish::redmax_energy_test {

constexpr double quarter_turn = std::numbers::pi / 2;

/// One joint: its axis and first angle (rad); none where fixed.
struct Joint {
  std::vector<Axis> axes;
  double angle = 0;
};

/// Cuboids of 10 x 1 x 1 cm and density 1 g/cm^3, each on a joint at the end of the one before.
ChainRun cuboids(const std::vector<Joint>& joints) {
  Body cuboid;
  cuboid.length = 10;
  cuboid.mass = 10;
  cuboid.inertia = cuboid.mass / 12 * Eigen::Vector3d(1 + 1, 100 + 1, 100 + 1);
  Model model;
  append_root(model, 0);
  std::vector<double> angles;
  for (const Joint& joint : joints) {
    append_body(model, cuboid, joint.axes);
    if (!joint.axes.empty()) {
      angles.push_back(joint.angle);
    }
  }
  model.gravity = {0, 0, -980};
  ChainRun run(model, bare_scene(1e-2));
  run.state.q.tail(angles.size()) = Eigen::Map<Eigen::VectorXd>(angles.data(), angles.size());
  return run;
}

double energy_gained(ChainRun run) {
  const double before = run.energy();
  for (int i = 0; i < 200; ++i) {
    run.step();
  }
  return run.energy() - before;
}

/// RedMax's own tolerance, erg. Energies of about 1e6 erg come and go, so that this is 1e-8 of
/// them: room for the rounding of 200 steps (1e-7 erg seen), not for another rule of time stepping.
constexpr double tolerance = 1e-2;

TEST(RedMaxEnergy, FixedJointsBetweenHinges) {
  const Joint hinge{{Axis::y}, quarter_turn / 2};
  const Joint fixed{};
  EXPECT_NEAR(energy_gained(cuboids({hinge, fixed, hinge, fixed, hinge})), -5930.8171118834871,
              tolerance);
}

TEST(RedMaxEnergy, HingesOfTurningAxes) {
  EXPECT_NEAR(energy_gained(
                  cuboids({{{Axis::z}, 0}, {{Axis::y}, quarter_turn}, {{Axis::z}, quarter_turn}})),
              -9423.2594023734018, tolerance);
}

TEST(RedMaxEnergy, LimitRowsOnceViolated) {
  ChainRun run = cuboids({{{Axis::y}, 0}, {{Axis::y}, 0}});
  run.model.hinges[1].lower = -quarter_turn / 2;
  run.model.hinges[1].upper = quarter_turn / 2;
  run.scene.constraints.activation = Activation::violated;
  run.scene.constraints.baumgarte = 5 * run.scene.time.step;  // RedMax: 5 / s times the violation
  EXPECT_NEAR(energy_gained(std::move(run)), 34838.892, tolerance);
}

}  // namespace hagfish::redmax_energy_test
