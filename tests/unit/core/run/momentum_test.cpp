// The momentum ledger closes to rounding on any motion, and does not on a wrong one.
#include "core/run/momentum.hpp"

#include <gtest/gtest.h>

#include "core/step/step.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::momentum_test {

/// A run of 20 bodies, pulled, clamped and falling where `held`, else free but for water.
struct MomentumRun {
  explicit MomentumRun(bool held, TimeRule rule = TimeRule::euler) {
    scene.time.rule = rule;
    if (held) scene.gravity = {30, -200, 100};
    scene.clamp_head = held;
    scene.wall.present = held;
    model = make_hagfish(table1_specimen(), scene);
    Random random(11);
    state = random_state(random, model, 0.2, 3);
    if (held) {
      state.q.head<7>() << 0, 0, 0, 1, 0, 0, 0;
      state.qdot.head<6>().setZero();
    }
    control.clamp_head = held;
    if (held) control.tip.value << 200, 300, -100;
    ledger = open_momentum(model, {state, observe(model, state, scene)});
  }
  template <class Spoil>
  void step(Spoil spoil) {
    const Observation now = observe(model, state, scene);
    StepSolution solution;
    const bool euler = scene.time.rule == TimeRule::euler;
    const StepInput in{model, scene, state, now, control};
    ASSERT_TRUE(solver.solve(in, solution).ok());
    const StepPlace place = solver.place(in);
    spoil(solution);
    if (euler) {
      solution.next = solution.felt = solution.qdot;
      solution.felt_twist = body_twists(model, place.kin, solution.qdot);
      solution.felt_centre_velocity = centre_velocities(place.kin, solution.felt_twist);
    }
    const State moved{advance(state.q, solution.qdot, scene.time.step), solution.next};
    Moment next{moved, observe(model, moved, scene)};
    energy.kinetic = kinetic_energy(model, next.observation.kin);
    book_momentum(in, place, solution, next, energy, ledger);
    state = next.state;
  }
  double imbalance(Eigen::Vector3d Momentum::*part) const {
    const Momentum off = ledger.momentum - ledger.initial - ledger.drag - ledger.outside -
                         ledger.integrator - ledger.given_back;
    return (off.*part).norm() / ((ledger.momentum.*part).norm() + (ledger.drag.*part).norm() +
                                 (ledger.outside.*part).norm());
  }
  double imbalance() const {
    return std::max(imbalance(&Momentum::linear), imbalance(&Momentum::angular));
  }

  Scene scene = table1_scene(20);
  Model model;
  State state;
  Control control;
  EnergyLedger energy;
  MomentumLedger ledger;
  StepSolver solver{"active-set"};
};

TEST(Momentum, LedgerClosesHeldOrFree) {
  for (const TimeRule rule : {TimeRule::euler, TimeRule::midpoint}) {
    for (const bool held : {true, false}) {
      MomentumRun run(held, rule);
      for (int k = 0; k < 50; ++k) run.step([](StepSolution&) {});
      EXPECT_LT(run.imbalance(), 1e-12) << held;  // rounding of 50 booked steps
      EXPECT_GT(run.ledger.drag.linear.norm(), 0);
      EXPECT_GT(run.ledger.drag.angular.norm(), 0);
      EXPECT_EQ(run.ledger.outside.linear.isZero(0), !held);
      EXPECT_EQ(run.ledger.outside.angular.isZero(0), !held);
    }
  }
}

TEST(Momentum, LedgerSeesAForceThatNobodyBooked) {
  // A push on the whole animal, and a turn, one part in a thousand of its speed.
  for (const auto part : {&Momentum::linear, &Momentum::angular}) {
    MomentumRun run(false);
    for (int k = 0; k < 50; ++k) {
      run.step(
          [&](StepSolution& s) { s.qdot.segment<3>(part == &Momentum::linear ? 0 : 3) *= 1.001; });
    }
    EXPECT_GT(run.imbalance(part), 1e-6);
  }
}

}  // namespace hagfish::momentum_test
