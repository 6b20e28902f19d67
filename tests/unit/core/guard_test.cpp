#include "core/guard.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "core/simulation.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"

namespace hagfish {
namespace {

std::string message_of(StopCause cause, const std::function<void()>& work) {
  try {
    work();
  } catch (const StepError& error) {
    EXPECT_EQ(error.cause(), cause) << error.what();
    return error.what();
  }
  return "no StepError";
}

/// A knot with a contact 0.18 cm too deep (random_chain.hpp).
struct DeepKnot {
  DeepKnot() {
    scene.wall.present = false;
    Random random(1);
    model = table1_hagfish();
    state = knotted_state(random, model);
    situation = observe(model, state, scene);
  }
  void look() { guard_state(model, state, situation, crossing, scene, watch, warnings); }
  Scene scene = table1_scene();
  Model model;
  State state;
  Situation situation;
  double crossing = 0;
  Watch watch;
  std::vector<std::string> warnings;
};

TEST(Guard, NamesTheBodiesThatOverlapAndWhatWouldHelp) {
  DeepKnot knot;
  knot.look();  // half a centimetre is permitted
  knot.scene.guard.penetration = 0.1;
  const std::string message = message_of(StopCause::penetration, [&] { knot.look(); });
  const auto deepest = std::ranges::min_element(knot.situation.contact.contacts, {}, &Contact::gap);
  EXPECT_NE(message.find("of bodies " + std::to_string(deepest->body_a()) + " and " +
                         std::to_string(deepest->body_b())),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("constraints.corrections"), std::string::npos) << message;
}

TEST(Guard, StopsAtWhatHappensOnTheWay) {
  DeepKnot knot;
  knot.crossing = 0.6;
  EXPECT_NE(message_of(StopCause::penetration, [&] { knot.look(); }).find("on the way"),
            std::string::npos);
}

TEST(Guard, NamesTheJointPastItsLimit) {
  DeepKnot knot;
  const Hinge& hinge = knot.model.hinges[4];
  knot.state.q[7 + 4] = hinge.upper + 0.3;
  knot.situation = observe(knot.model, knot.state, knot.scene);
  knot.scene.guard.penetration = 100;
  const std::string message = message_of(StopCause::limits, [&] { knot.look(); });
  EXPECT_EQ(message.find(dof_name(knot.model, root_dofs + 4) + " is 17.2 deg past"), 0u) << message;
}

TEST(Guard, WarnsOnceWhereTheSceneAsksForIt) {
  DeepKnot knot;
  knot.scene.guard.penetration = 0.1;
  knot.scene.guard.action = GuardAction::warn;
  knot.look();
  knot.look();
  ASSERT_EQ(knot.warnings.size(), 1u);
  EXPECT_EQ(knot.warnings[0].find("penetration 0."), 0u) << knot.warnings[0];
}

TEST(Guard, StopsAtSpeed) {
  Eigen::Matrix3Xd velocity = Eigen::Matrix3Xd::Zero(3, 5);
  GuardSettings guard;
  guard_speed(velocity, guard);
  velocity.col(3) << 0, 0, 2 * guard.speed;
  EXPECT_EQ(message_of(StopCause::speed, [&] { guard_speed(velocity, guard); }).find("body 3 "),
            0u);
  velocity(0, 3) = std::numeric_limits<double>::quiet_NaN();
  message_of(StopCause::speed, [&] { guard_speed(velocity, guard); });
}

TEST(Guard, TellsOfARowThatStaysAtItsCapAndWhatHoldsItBack) {
  const Model model = table1_hagfish();
  Scene scene = table1_scene();
  scene.guard.capped_time = 0.1;
  StepSolution step;
  append_thigmotaxis_rows(model, {{Contact{}, {1, 1}}, {Contact{}, {1, 1}}}, 10, 1, step.rows);
  const std::vector<Row> limits = limit_rows(model, rest_state(model), scene.constraints, 1);
  step.rows.insert(step.rows.end(), limits.begin(), limits.begin() + 3);
  step.lambda.resize(7);
  step.lambda << 3, 10, 0, 9, 5, 0, 1;  // the second one is at the cap
  step.excess = Eigen::VectorXd::Constant(7, -0.5);
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(7, 7);
  A.row(1) << 0.1, 1, -5, 0, -1, -9, -7;  // rows 6 and 4 work against it; 2 and 5 have no force
  Watch watch;
  std::vector<std::string> warnings;
  for (const double time : {0.0, 0.05, 0.1}) {
    guard_cap(model, scene, step, A, time, watch, warnings);
  }
  EXPECT_TRUE(warnings.empty());
  guard_cap(model, scene, step, A, 0.11, watch, warnings);
  guard_cap(model, scene, step, A, 0.12, watch, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("first thigmotaxis contact, along t_b has been at controller.cap"), 0u)
      << warnings[0];
  EXPECT_NE(warnings[0].find("held back most by " + row_name(model, step.rows[6]) + "; " +
                             row_name(model, step.rows[4]) + "; a lower"),
            std::string::npos)
      << warnings[0];
}

TEST(Guard, ARowBelowItsCapForAStepStartsAnew) {
  const Model model = table1_hagfish();
  Scene scene = table1_scene();
  scene.guard.capped_time = 0.1;
  StepSolution step;
  append_thigmotaxis_rows(model, {{Contact{}, {1, 1}}}, 10, 1, step.rows);
  step.excess = Eigen::VectorXd::Zero(2);
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(2, 2);
  Watch watch;
  std::vector<std::string> warnings;
  for (int k = 0; k < 10; ++k) {
    step.lambda.setZero(2);
    step.lambda[0] = k == 5 ? 9 : 10;
    guard_cap(model, scene, step, A, 0.02 * k, watch, warnings);
  }
  EXPECT_TRUE(warnings.empty());
}

/// A body bent evenly that turns about its root without damping: explicit Coriolis forces feed it.
class EnergyWatch : public testing::Test {
 protected:
  EnergyWatch() {
    scene = table1_scene(20);
    scene.clamp_head = false;
    scene.wall.present = false;
    scene.drag = {};
    scene.model.bending_stiffness = 0;
    scene.model.twist_stiffness = 0;
    scene.time.step = 0.005;
    model = make_hagfish(table1_specimen(), scene);
    for (Hinge& hinge : model.hinges) {  // a limit's impacts would hide what is made
      hinge.lower = -std::numeric_limits<double>::infinity();
      hinge.upper = std::numeric_limits<double>::infinity();
    }
  }
  /// Energy at the end over that at the start.
  double growth(EnergyAction action, int steps = 400) {
    scene.guard.energy_action = action;
    scene.contact.least_arc = 100;  // strands pass each other: no impacts
    State state = bent_state(model, 0.05, 0);
    state.qdot.tail(model.nv() - root_dofs).setConstant(2);
    Simulation sim = start_from(model, scene, state, {}, 0);
    const auto solver = make_box_qp_solver("active-set");
    StepRecord record;
    for (int k = 0; k < steps; ++k) {
      take_step(model, scene, *solver, sim, record);
      for (const std::string& warning : record.warnings) {
        warnings.push_back(warning);
      }
      // The ledger closes to rounding, what was taken back included.
      EXPECT_LT(std::abs(sim.ledger.imbalance()), 1e-9 * sim.ledger.initial);
      // The velocity that goes on is the one that the ledger speaks of.
      EXPECT_NEAR(kinetic_energy(model, kinematics(model, sim.state)), sim.ledger.kinetic,
                  1e-9 * sim.ledger.initial);
    }
    return (sim.ledger.kinetic + sim.ledger.elastic) / sim.ledger.initial;
  }
  Scene scene;
  Model model;
  std::vector<std::string> warnings;
};

TEST_F(EnergyWatch, HoldsWhatTheIntegratorMakes) {
  EXPECT_LE(growth(EnergyAction::hold), 1 + 1.02 * scene.guard.energy_gain);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("the integrator made"), 0u) << warnings[0];
}

TEST_F(EnergyWatch, TakesNothingFromABodyAtRest) {
  State state = rest_state(model);
  Kinematics kin = kinematics(model, state);
  EnergyLedger ledger = open_ledger(model, state, kin);
  ledger.integrator_coriolis = 1;
  Watch watch;
  guard_energy(model, scene, state, kin, ledger, watch, warnings);
  EXPECT_TRUE(state.qdot.isZero(0));
  EXPECT_EQ(ledger.kinetic, 0);
  EXPECT_EQ(warnings.size(), 1u);
}

TEST_F(EnergyWatch, OnlyWarnsWhereTheSceneAsksForIt) {
  EXPECT_GT(growth(EnergyAction::warn, 40), 1.1);
  EXPECT_EQ(warnings.size(), 1u);
}

TEST_F(EnergyWatch, StopsWhereTheSceneAsksForIt) {
  EXPECT_NE(message_of(StopCause::energy_gain, [&] { growth(EnergyAction::stop); })
                .find("guard.energy_gain = 0.005"),
            std::string::npos);
}

}  // namespace
}  // namespace hagfish
