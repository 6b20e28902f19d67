// The momentum ledger closes to rounding on any motion, and does not on a wrong one.
#include "core/run/momentum.hpp"

#include <gtest/gtest.h>

#include <array>

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
    Random random(2);
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
      solution.next = solution.mean_velocity = solution.qdot;
      solution.mean_twist = body_twists(model, place.kin, solution.qdot);
      solution.mean_centre_velocity = centre_velocities(place.kin, solution.mean_twist);
    }
    const State moved{advance(state.q, solution.qdot, scene.time.step), solution.next};
    ObservedState next{moved, observe(model, moved, scene)};
    const double kinetic = energy.kinetic = kinetic_energy(model, next.observation.kin);
    const double inner = inner_kinetic_energy(model, next.observation.kin);
    before = ledger;
    shift = {centre_after(in, place, solution, before.momentum, 0) - centre_of_mass(model, now.kin),
             centre_after(in, place, solution, before.momentum, scene.time.step / 3) -
                 centre_of_mass(model, now.kin)};
    book_momentum(in, place, solution, next, energy, ledger);
    gain = inner_kinetic_energy(model, next.observation.kin) / inner - 1;
    added = energy.kinetic - kinetic;
    EXPECT_NEAR(kinetic_energy(model, kinematics(model, next.state)), energy.kinetic,
                1e-12 * kinetic);
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
  double gain = 0;                       ///< of inner kinetic energy, by what was last given back
  double added = 0;                      ///< to all kinetic energy by it, erg
  MomentumLedger ledger, before;         ///< the last step's
  std::array<Eigen::Vector3d, 2> shift;  ///< of the centre of mass in no time and a third of it
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

// Nothing of a step's momentum is the rule's while nothing holds the head, where the scene says so.
TEST(Momentum, OfAFreeBodyIsWhatImpulsesLeave) {
  for (const TimeRule rule : {TimeRule::euler, TimeRule::midpoint}) {
    for (const bool kept : {true, false}) {
      MomentumRun run(false, rule);
      run.scene.time.momentum = kept ? FreeMomentum::kept : FreeMomentum::rule;
      for (int k = 0; k < 50; ++k) {
        run.step([](StepSolution&) {});
        EXPECT_LT(std::abs(run.gain), 1e-12);
      }
      const MomentumLedger& of = run.ledger;
      const Momentum made = of.integrator + of.given_back;
      EXPECT_EQ(made.linear.norm() < 1e-10 * of.initial.linear.norm(), kept) << made.linear.norm();
      EXPECT_EQ(made.angular.norm() < 1e-10 * of.initial.angular.norm(), kept);
      EXPECT_EQ(of.given_back.linear.isZero(0), !kept);
      EXPECT_EQ(of.given_back.angular.isZero(0), !kept);
    }
  }
}

// A body without motion between its parts has no energy to turn faster by: a little of its angular
// momentum is given back, and booked; more is not.
TEST(Momentum, OfARigidMotionIsGivenBackWithItsEnergy) {
  for (const double share : {0.9999, 0.994, 0.98}) {
    MomentumRun run(false);
    run.model.drag = {};
    run.state.qdot.tail(run.model.nv() - root_dofs).setZero();
    run.ledger = open_momentum(run.model, {run.state, observe(run.model, run.state, run.scene)});
    const Eigen::VectorXd motion = share * run.state.qdot;
    run.step([&](StepSolution& s) { s.qdot = motion; });
    const bool given = share > 0.99;
    const Momentum left = run.ledger.momentum - run.ledger.initial;
    EXPECT_LT(left.linear.norm(), 1e-12 * run.ledger.initial.linear.norm());
    EXPECT_EQ(left.angular.norm() < 1e-12 * run.ledger.initial.angular.norm(), given);
    EXPECT_EQ(std::abs(run.gain) > 1e-6, given) << run.gain;
    EXPECT_NEAR(run.energy.integrator_momentum, run.added, 1e-12 * run.energy.kinetic);
  }
}

// By Euler's rule with all of the step's impulse, by the midpoint rule with half of it: also over a
// part of a step.
TEST(Momentum, TheCentreOfMassMovesByIt) {
  for (const TimeRule rule : {TimeRule::euler, TimeRule::midpoint}) {
    MomentumRun run(false, rule);
    run.scene.time.settled = 1e-10;
    for (int k = 0; k < 3; ++k) run.step([](StepSolution&) {});
    const Eigen::Vector3d impulse = (run.ledger.drag - run.before.drag).linear;
    const double h = run.scene.time.step;
    const Eigen::Vector3d moved =
        h / 3 / run.model.mass() *
        (run.before.momentum.linear + run.scene.time.reach() / h * impulse);
    EXPECT_TRUE(run.shift[0].isZero(1e-14)) << run.shift[0].transpose();
    const double tolerance = rule == TimeRule::euler ? 1e-12 : 1e-8;  // passes find the middle
    EXPECT_LT((run.shift[1] - moved).norm(), tolerance * moved.norm());
  }
}

}  // namespace hagfish::momentum_test
