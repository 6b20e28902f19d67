// The energy ledger: it must close to rounding on any motion, and must not close on a wrong one.
#include "core/run/energy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/step/step.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::energy_test {

Control control(bool clamp_head, const TipForce& tip = {}, const ActiveTorque& active = {}) {
  Control made;
  made.clamp_head = clamp_head;
  made.tip = tip;
  made.active = active;
  return made;
}

/// A run of a scene from a state, booked step by step.
struct BookedRun {
  Model model;
  Scene scene;
  State state;
  EnergyLedger ledger;

  BookedRun(Model of, Scene in, State from)
      : model(std::move(of)), scene(std::move(in)), state(std::move(from)) {
    ledger = open_ledger(model, {state, observe(model, state, scene)}, false);
  }
  /// `spoil` changes the solved step before it is taken and booked. It moves for `share` of its
  /// length.
  template <class Spoil>
  void step(const Control& control, Spoil spoil, double share = 1) {
    const Observation now = observe(model, state, scene);
    StepSolution solution;
    const StepInput in{model, scene, state, now, control};
    ASSERT_TRUE(solver.solve(in, solution).ok());
    const StepPlace place = solver.place(in);
    spoil(solution);
    solution.twist = body_twists(model, place.kin, solution.qdot);
    solution.centre_velocity = centre_velocities(place.kin, solution.twist);
    if (scene.time.rule == TimeRule::euler) {
      solution.next = solution.mean_velocity = solution.qdot;
      solution.mean_twist = solution.twist;
      solution.mean_centre_velocity = solution.centre_velocity;
    }
    const double h = scene.time.step;
    const State next{advance(state.q, solution.qdot, share * h), solution.next};
    book_step(in, place, solution, {next, observe(model, next, scene)}, share * h, ledger);
    state = next;
  }
  void step(const Control& control, double share = 1) {
    step(
        control, [](StepSolution&) {}, share);
  }
  double throughput() const {
    return std::abs(ledger.initial) + std::abs(ledger.works()) + ledger.dissipated +
           std::abs(ledger.kinetic) + std::abs(ledger.gravity) + std::abs(ledger.elastic);
  }

  StepSolver solver{"ipopt"};
};

/// Torques of muscles at every hinge, some stiff.
ActiveTorque muscles(const Model& model) {
  Random random(9);
  ActiveTorque torque{random_entries(random, model.nv(), 500),
                      random_entries(random, model.nv(), 50).cwiseAbs()};
  torque.value.head<root_dofs>().setZero();
  torque.rate.head<root_dofs>().setZero();
  return torque;
}

/// Everything on: gravity, drag, stiffness, damping, limits, a head plate and a pulled tail.
BookedRun busy_run(unsigned seed, double h, TimeRule rule) {
  Random random(seed);
  Scene scene = table1_scene(20);
  scene.time.step = h;
  scene.time.rule = rule;
  scene.gravity = {30, -200, 100};
  scene.model.bending_damping = 5;
  scene.model.twist_damping = 5;
  Model model = make_hagfish(table1_specimen(), scene);
  State state = random_state(random, model, 0.2, 3);
  state.q.head<7>() << 0, 0, 0, 1, 0, 0, 0;
  state.qdot.head<6>().setZero();
  return {std::move(model), std::move(scene), std::move(state)};
}

class EnergyOf : public testing::TestWithParam<TimeRule> {};

INSTANTIATE_TEST_SUITE_P(Rules, EnergyOf, testing::Values(TimeRule::euler, TimeRule::midpoint),
                         [](const auto& test) {
                           return test.param == TimeRule::euler ? "euler" : "midpoint";
                         });

TEST_P(EnergyOf, LedgerClosesWithEveryKindOfForceAlsoWhereStepsEndEarly) {
  for (const double h : {5e-4, 2e-3, 1e-2}) {
    BookedRun run = busy_run(1, h, GetParam());
    Random random(5);
    for (int k = 0; k < 150; ++k) {
      const double share = k < 50 || k % 5 == 0 ? 1 : k % 7 == 0 ? 0 : uniform(random, 0, 1);
      run.step(control(true, {{200, 300, -100}, 0}, muscles(run.model)), share);
    }
    // Rounding of 150 booked steps, each exact to some 1e-14 of what passes.
    EXPECT_LE(std::abs(run.ledger.imbalance()), 1e-11 * run.throughput()) << "h = " << h;
    EXPECT_NE(run.ledger.work_tip, 0);
    EXPECT_NE(run.ledger.work_active, 0);
    EXPECT_NE(run.ledger.work[RowKind::limit], 0);
    EXPECT_GT(run.ledger.dissipated, 0);
  }
}

/// The animal squeezed between two poles and pulled through, with a soft head plate.
BookedRun squeezed_run(double h, TimeRule rule) {
  BookedRun run = busy_run(1, h, rule);
  Scene& scene = run.scene;
  scene.flesh = {1e5, 0.015, 0.212};
  const Eigen::Vector3d middle = kinematics(run.model, run.state).centre.col(10);
  for (const double side : {-0.9, 0.9}) {  // cm
    const Eigen::Vector3d at = middle + side * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d half = 9 * Eigen::Vector3d::UnitZ();
    run.model.obstacles.push_back({"pole", Strand{{at - half, at + half}, 0.3}});
  }
  return {std::move(run.model), std::move(scene), std::move(run.state)};
}

TEST_P(EnergyOf, LedgerClosesWithFlesh) {
  for (const double h : {5e-4, 2e-3, 1e-2}) {
    BookedRun run = squeezed_run(h, GetParam());
    const double hard = elastic_energy(run.model, run.state.q);
    EXPECT_GT(run.ledger.elastic, hard + 100);  // stored in flesh
    for (int k = 0; k < 100; ++k) {
      run.step(control(true, {{200, 300, -100}, 0}, muscles(run.model)));
    }
    EXPECT_LE(std::abs(run.ledger.imbalance()), 1e-11 * run.throughput()) << "h = " << h;
    EXPECT_EQ(run.ledger.work[RowKind::contact], 0);
    EXPECT_NEAR(run.ledger.work[RowKind::obstacle], 0, 1e-11 * run.throughput());
  }
}

// What springs and dampers take of a motion is what is missing of it, but for what the rule makes,
// which vanishes with the step.
TEST_P(EnergyOf, FleshTakesWhatItsLawSays) {
  double coarse = 0;
  for (const double h : {1e-3, 2.5e-4}) {
    BookedRun run = squeezed_run(h, GetParam());
    for (double time = 0; time < 0.05; time += h) run.step(control(true));
    const double made = std::abs(run.ledger.integrator_potential);
    if (coarse > 0) {
      EXPECT_LT(made, 0.5 * coarse);
    }
    coarse = made;
  }
}

TEST(Energy, LedgerSeesForcesThatDoNotAddUp) {
  BookedRun run = busy_run(2, 2e-3, TimeRule::euler);
  for (int k = 0; k < 20; ++k) {
    // One part in a thousand of one hinge's rate has no force that explains it.
    run.step(control(true), [](StepSolution& s) { s.qdot[s.qdot.size() / 2] *= 1.001; });
  }
  EXPECT_GT(std::abs(run.ledger.imbalance()), 1e-8 * run.throughput());
}

}  // namespace hagfish::energy_test
