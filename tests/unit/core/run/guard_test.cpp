#include "core/run/guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/run/simulation.hpp"
#include "core/step/look_ahead.hpp"
#include "core/step/paper_step.hpp"
#include "core/step/rows/dual_problem.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"

namespace hagfish::guard_test {

std::string message_of(Outcome outcome, const Status& status) {
  EXPECT_EQ(status.outcome, outcome) << status.message;
  return status.message;
}

/// A knot with a contact 0.18 cm too deep (random_chain.hpp).
struct DeepKnot {
  DeepKnot() {
    Random random(1);
    model = table1_hagfish();
    model.obstacles.clear();
    state = knotted_state(random, model);
    observation = observe(model, state, scene);
  }
  Status look() {
    return guard_state(model, {state, observation}, crossing, scene, watch, warnings);
  }
  Scene scene = table1_scene();
  Model model;
  State state;
  Observation observation;
  double crossing = 0;
  Watch watch;
  std::vector<std::string> warnings;
};

TEST(Guard, NamesTheBodiesThatOverlapAndWhatWouldHelp) {
  DeepKnot knot;
  EXPECT_TRUE(knot.look().ok());  // half a centimetre is permitted
  knot.scene.guard.penetration = 0.1;
  const std::string message = message_of(Outcome::penetration, knot.look());
  const auto deepest =
      std::ranges::min_element(knot.observation.contact.contacts, {}, &Contact::gap);
  EXPECT_NE(message.find("bodies " + std::to_string(deepest->body_a()) + " and " +
                         std::to_string(deepest->body_b())),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("constraints.corrections"), std::string::npos) << message;
}

TEST(Guard, StopsAtWhatHappensOnTheWay) {
  DeepKnot knot;
  knot.crossing = 0.6;
  EXPECT_NE(message_of(Outcome::penetration, knot.look()).find("on the way"), std::string::npos);
}

/// What a warning says: what happened, whether the run can be used, and what to do, in two
/// sentences at most.
void expect_told(const std::string& warning) {
  std::size_t ends = 0;
  for (std::size_t at = 0; (at = warning.find(". ", at)) != std::string::npos; ++at) ++ends;
  EXPECT_EQ(ends, 1u) << warning;
  EXPECT_TRUE(warning.find("can be used") != std::string::npos ||
              warning.find("Do not use") != std::string::npos)
      << warning;
  EXPECT_NE(warning.rfind("try "), std::string::npos) << warning;
  EXPECT_GT(warning.rfind("try "), warning.rfind(" use")) << warning;
}

TEST(Guard, NamesTheJointPastItsLimit) {
  DeepKnot knot;
  const Hinge& hinge = knot.model.hinges[4];
  knot.state.q[7 + 4] = hinge.upper + 0.3;
  knot.observation = observe(knot.model, knot.state, knot.scene);
  knot.scene.guard.penetration = 100;
  const std::string message = message_of(Outcome::limits, knot.look());
  EXPECT_EQ(message.find(dof_name(knot.model, root_dofs + 4) + " is 17.2 deg past"), 0u) << message;
}

TEST(Guard, WarnsOnceWhereTheSceneAsksForIt) {
  DeepKnot knot;
  knot.scene.guard.penetration = 0.1;
  knot.scene.guard.action = GuardAction::warn;
  EXPECT_TRUE(knot.look().ok());
  EXPECT_TRUE(knot.look().ok());
  ASSERT_EQ(knot.warnings.size(), 1u);
  EXPECT_NE(knot.warnings[0].find(" overlap by 0."), std::string::npos) << knot.warnings[0];
  expect_told(knot.warnings[0]);
}

const Eigen::Vector3d still = Eigen::Vector3d::Zero();  // an observer who stands

TEST(Guard, StopsAtSpeed) {
  Eigen::Matrix3Xd velocity = Eigen::Matrix3Xd::Zero(3, 5);
  Scene scene;
  EXPECT_TRUE(guard_speed(velocity, still, scene).ok());
  velocity.col(3) << 0, 0, 2 * scene.guard.speed;
  EXPECT_EQ(message_of(Outcome::speed, guard_speed(velocity, still, scene)).find("body 3 moves at"),
            0u);
  velocity(0, 3) = std::numeric_limits<double>::quiet_NaN();
  message_of(Outcome::speed, guard_speed(velocity, still, scene));
}

TEST(Guard, StopsAStepWhosePathIsTooLongToLookAlong) {
  Scene scene;
  Eigen::Matrix3Xd velocity = Eigen::Matrix3Xd::Zero(3, 5);
  velocity(1, 2) = 100;
  scene.time.step = 0.99 * most_path_samples * scene.constraints.stride / 100;
  EXPECT_TRUE(guard_speed(velocity, still, scene).ok());
  EXPECT_LE(path_samples(velocity, still, scene.time.step, scene.constraints.stride),
            most_path_samples);
  scene.time.step *= 1.02;
  EXPECT_EQ(message_of(Outcome::speed, guard_speed(velocity, still, scene))
                .find("body 2 moves 2.52e+03 cm"),
            0u);
}

TEST(Guard, TellsOnceWhatMusclesCannotDo) {
  const Model model = table1_hagfish();
  Scene scene = table1_scene();
  scene.active.capacity = 1e5;
  Control control;
  Eigen::VectorXd& rest = control.rest_shape;
  rest = Eigen::VectorXd::Zero(model.nv());
  Watch watch;
  std::vector<std::string> warnings;
  const auto look = [&] { guard_muscles(model, scene, control, 1, watch, warnings); };
  rest[7] = model.hinges[1].upper + 0.01;  // within what a fitted program may pass a limit by
  look();
  EXPECT_TRUE(warnings.empty());
  rest[7] = model.hinges[1].lower - 0.3;
  control.active.saturated = 8;
  look();
  look();
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].find("the curvature program bends " + dof_name(model, 7) + " to -"), 0u)
      << warnings[0];
  EXPECT_NE(warnings[0].find(" at 1.00 s"), std::string::npos) << warnings[0];
  EXPECT_EQ(
      warnings[1].find(dof_name(model, 8) + " needs more torque than active.capacity = 100000"), 0u)
      << warnings[1];
  for (const std::string& warning : warnings) expect_told(warning);
}

/// The knot with thigmotaxis rows at one of its contacts, twice, and three limits.
struct CappedRow {
  CappedRow() {
    Random random(131);
    scene.guard.capped_time = 0.1;
    const State state = knotted_state(random, model, 2.45, 0.002);
    now = observe(model, state, scene);
    step.system = step_system(model, state, now.kin, {}, scene.time.step);
    const Contact& contact = now.contact.contacts.at(0);
    scene.controller.cap = 10;
    append_thigmotaxis_rows(model,
                            {{contact, {1, 1}, BodyEnd::head, 1, KnotEnd::first},
                             {contact, {1, 1}, BodyEnd::head, 1, KnotEnd::last}},
                            {now.kin, now.segments, false}, scene, 1, step.rows);
    const std::vector<Row> limits = limit_rows(model, state, scene.constraints, 1);
    step.rows.insert(step.rows.end(), limits.begin() + 20, limits.begin() + 23);
    step.qdot = Eigen::VectorXd::Zero(model.nv());
    step.centre_velocity = Eigen::Matrix3Xd::Zero(3, model.body_count());
    step.lambda.resize(7);
    step.lambda << 3, 10, 0, 9, 5, 7, 1;  // the second one is at the cap
    step.excess = Eigen::VectorXd::Constant(7, -0.5);
  }
  void look(double time) { guard_cap(model, now.kin, scene, phase, step, time, watch, warnings); }

  Model model = table1_hagfish();
  Scene scene = table1_scene();
  Observation now;
  StepSolution step;
  Phase phase = Phase::slide;
  Watch watch;
  std::vector<std::string> warnings;
};

TEST(Guard, TellsOfARowThatStaysAtItsCapAndWhatHoldsItBack) {
  CappedRow capped;
  const StepSolution& step = capped.step;
  for (const double time : {0.0, 0.05, 0.1}) {
    capped.look(time);
  }
  EXPECT_TRUE(capped.warnings.empty());
  capped.look(0.11);
  capped.look(0.12);
  ASSERT_EQ(capped.warnings.size(), 1u);
  const std::string& warning = capped.warnings[0];
  EXPECT_EQ(warning.find("first thigmotaxis contact, along t_b has been at controller.cap"), 0u)
      << warning;
  // What each row's force does to the velocity of the second, by dense algebra.
  const Eigen::MatrixXd c = dense_rows(capped.model, capped.now.kin, step.rows);
  const Eigen::MatrixXd h = dense(capped.model, capped.now.kin, step.system.op);
  const Eigen::VectorXd effect =
      (c * h.llt().solve(c.row(1).transpose())).cwiseProduct(step.lambda);
  std::vector<std::pair<double, std::size_t>> hardest;
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    if (i != 1 && effect[static_cast<Eigen::Index>(i)] < 0) {
      hardest.emplace_back(effect[static_cast<Eigen::Index>(i)], i);
    }
  }
  std::ranges::sort(hardest);
  ASSERT_GE(hardest.size(), 2u);
  EXPECT_NE(
      warning.find("held back most by " + row_name(capped.model, step.rows[hardest[0].second]) +
                   "; " + row_name(capped.model, step.rows[hardest[1].second])),
      std::string::npos)
      << warning;
}

TEST(Guard, TellsWhyARowIsAtItsCap) {
  // One other row alone holds the second back, by whichever sign works against it.
  const std::tuple<Eigen::Index, bool, const char*> causes[] = {
      {0, false, "it cannot have both speeds"},
      {0, false, "controller.eq6_slip"},
      {3, false, "try a lower speed or a higher cap"},
      {4, false, "joint limits block the motion"},
      {4, true, "an obstacle is in the way"}};
  for (const auto& [other, plate, told] : causes) {
    CappedRow capped;
    StepSolution& step = capped.step;
    if (plate) step.rows[4] = plane_row({0, *capped.model.obstacles[0].plane(), 30, 0});
    step.lambda.setZero();
    step.lambda[1] = step.rows[1].upper;
    const Eigen::MatrixXd A = whole_dual(capped.model, capped.now.kin, step.system, step.rows).A;
    step.lambda[other] = A(1, other) < 0 ? 1 : -1;
    for (const double time : {0.0, 0.2}) capped.look(time);
    expect_told(capped.warnings.at(0));
    EXPECT_NE(capped.warnings[0].find(told), std::string::npos) << capped.warnings[0];
  }
}

TEST(Guard, ARowBelowItsCapForAStepStartsAnew) {
  CappedRow capped;
  for (int k = 0; k < 10; ++k) {
    capped.step.lambda[1] = k == 5 ? 9 : 10;
    capped.look(0.02 * k);
  }
  EXPECT_TRUE(capped.warnings.empty());
}

TEST(Guard, AKnotThatPullsGivesAllItMay) {
  CappedRow capped;
  capped.phase = Phase::pull;
  for (int k = 0; k < 10; ++k) {
    capped.look(0.02 * k);
  }
  EXPECT_TRUE(capped.warnings.empty());
  capped.phase = Phase::release;  // which counts from here
  capped.look(0.2);
  capped.look(0.25);
  EXPECT_TRUE(capped.warnings.empty());
  capped.look(0.31);
  EXPECT_EQ(capped.warnings.size(), 1u);
}

TEST(Guard, WatchesTheCapOfAnyNumberOfContacts) {
  CappedRow capped;
  std::vector<ThigmotaxisCommand> commands;
  for (const Contact& contact : capped.now.contact.contacts) commands.push_back({contact, {1, 1}});
  ASSERT_GE(commands.size(), 3u);
  capped.step.rows.clear();
  append_thigmotaxis_rows(capped.model, commands, {capped.now.kin, capped.now.segments, false},
                          capped.scene, 1, capped.step.rows);
  const auto count = static_cast<Eigen::Index>(capped.step.rows.size());
  capped.step.lambda = Eigen::VectorXd::Zero(count);
  capped.step.excess = Eigen::VectorXd::Constant(count, -0.5);
  const Contact& last = commands.back().contact;
  // One row stays at its cap, another is at it now and then.
  for (const double time : {0.0, 0.05, 0.11}) {
    capped.step.lambda[count - 1] = 10;
    capped.step.lambda[0] = time == 0.05 ? 0 : 10;
    // In another order from step to step, as rows of contacts that come and go.
    std::ranges::rotate(capped.step.rows, capped.step.rows.begin() + 2);
    std::rotate(capped.step.lambda.begin(), capped.step.lambda.begin() + 2,
                capped.step.lambda.end());
    capped.look(time);
    std::ranges::rotate(capped.step.rows, capped.step.rows.end() - 2);
    std::rotate(capped.step.lambda.begin(), capped.step.lambda.end() - 2, capped.step.lambda.end());
  }
  ASSERT_EQ(capped.warnings.size(), 1u);
  EXPECT_EQ(capped.warnings[0].find("thigmotaxis of bodies " + std::to_string(last.segment_a) +
                                    " and " + std::to_string(last.segment_b) + ", along t_b has"),
            0u)
      << capped.warnings[0];
  EXPECT_EQ(capped.watch.capped.size(), 2u);
}

/// What the integrator made of the momentum of a free body, step by step.
class MomentumWatch : public testing::Test {
 protected:
  MomentumWatch() {
    control.clamp_head = false;
    energy.largest = 1000;
  }
  /// A step that makes `made`. Its warnings.
  std::vector<std::string> look(const Momentum& made, const Momentum& given_back = {}) {
    const MomentumLedger before = ledger;
    ledger.integrator += made;
    ledger.given_back += given_back;
    std::vector<std::string> warnings;
    guard_momentum({model, scene, state, now, control}, 0, before, ledger, energy, watch, warnings);
    return warnings;
  }

  Scene scene = table1_scene(20);
  Model model = make_hagfish(table1_specimen(), scene);
  State state = rest_state(model);
  Observation now = observe(model, state, scene);
  Control control;
  EnergyLedger energy;
  MomentumLedger ledger;
  Watch watch;
  // A thousandth of the most that a straight body of this energy can have.
  double linear = 0.001 * std::sqrt(2 * 1000 * table1_specimen().mass);
  double angular = linear * model.length() / std::sqrt(12.0);
  Eigen::Vector3d along{0.6, 0, -0.8};
};

TEST_F(MomentumWatch, WarnsOnceOfAPushOrATurnOfTheIntegratorsOwn) {
  for (const bool pushed : {true, false}) {
    watch = {};
    const auto made = [&](double share) {
      return Momentum{(pushed ? share * linear : 0) * along,
                      (pushed ? 0 : share * angular) * along};
    };
    EXPECT_TRUE(look(made(0.99)).empty());
    const std::vector<std::string> warnings = look(made(0.02));  // 1.01 in all
    ASSERT_EQ(warnings.size(), 1u) << pushed;
    EXPECT_NE(warnings[0].find("over 0.001 of the most"), std::string::npos) << warnings[0];
    EXPECT_TRUE(look(made(5)).empty());
  }
}

TEST_F(MomentumWatch, CountsWhatIsGivenBackAndStartsAnewWhereTheHeadIsHeld) {
  const Momentum push{5 * linear * along, 5 * angular * along};
  EXPECT_TRUE(look(push, push * -1).empty());
  const Momentum half = push * 0.15;  // 0.75 of what is allowed
  EXPECT_TRUE(look(half).empty());
  control.clamp_head = true;
  EXPECT_TRUE(look(push).empty());
  control.clamp_head = false;
  EXPECT_TRUE(look(half).empty());
  EXPECT_EQ(look(half).size(), 1u);
}

/// A body bent evenly that turns about its root without damping: explicit Coriolis forces feed it.
class EnergyWatch : public testing::Test {
 protected:
  EnergyWatch() {
    scene = table1_scene(20);
    scene.clamp_head = control.clamp_head = false;
    scene.wall.present = false;
    scene.drag = {};
    scene.model.bending_stiffness = 0;
    scene.model.twist_stiffness = 0;
    scene.time.step = 0.005;
    scene.time.momentum = FreeMomentum::rule;  // what the rule makes is to be seen
    model = make_hagfish(table1_specimen(), scene);
    for (Hinge& hinge : model.hinges) {  // a limit's impacts would hide what is made
      hinge.lower = -std::numeric_limits<double>::infinity();
      hinge.upper = std::numeric_limits<double>::infinity();
    }
  }
  /// Energy about the centre of mass at the end over that at the start.
  double growth(EnergyAction action, int steps = 400) {
    scene.guard.energy_action = action;
    scene.contact.least_arc = 100;  // strands pass each other: no impacts
    State state = bent_state(model, 0.05, 0);
    state.qdot.tail(model.nv() - root_dofs).setConstant(2);
    Simulation sim = start_from(model, scene, "active-set", state, {}, 0);
    const auto inner = [&] {
      return inner_kinetic_energy(model, sim.now.observation.kin) + sim.ledger.elastic;
    };
    const double before = inner();
    StepRecord record;
    for (int k = 0; k < steps; ++k) {
      take_step(model, scene, sim, record);
      for (const std::string& warning : record.warnings) {  // of momentum it warns too
        if (warning.starts_with("numerical errors added")) warnings.push_back(warning);
      }
      // The ledger closes to rounding, what was taken back included.
      EXPECT_LT(std::abs(sim.ledger.imbalance()), 1e-9 * sim.ledger.initial);
      // The velocity that goes on is the one that the ledger speaks of.
      EXPECT_NEAR(kinetic_energy(model, kinematics(model, sim.now.state)), sim.ledger.kinetic,
                  1e-9 * sim.ledger.initial);
    }
    return inner() / before;
  }
  Scene scene;
  Control control;
  Model model;
  std::vector<std::string> warnings;
};

TEST_F(EnergyWatch, HoldsWhatTheIntegratorMakes) {
  EXPECT_LE(growth(EnergyAction::hold), 1 + 1.02 * scene.guard.energy_gain);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("numerical errors added"), 0u) << warnings[0];
  expect_told(warnings[0]);
}

TEST_F(EnergyWatch, TakesNothingFromABodyAtRest) {
  ObservedState after{rest_state(model), observe(model, rest_state(model), scene)};
  EnergyLedger ledger = open_ledger(model, after, true);
  const ObservedState at = after;
  ledger.integrator_coriolis = 1;
  Watch watch;
  EXPECT_TRUE(guard_energy({model, scene, at.state, at.observation, control}, 0, after, ledger,
                           watch, warnings)
                  .ok());
  EXPECT_TRUE(after.state.qdot.isZero(0));
  EXPECT_EQ(ledger.kinetic, 0);
  EXPECT_EQ(warnings.size(), 1u);
}

TEST_F(EnergyWatch, OnlyWarnsByTheMidpointRule) {
  State moving = rest_state(model);
  moving.qdot.setConstant(1);
  for (const TimeRule rule : {TimeRule::euler, TimeRule::midpoint}) {
    scene.time.rule = rule;
    ObservedState after{moving, observe(model, moving, scene)};
    EnergyLedger ledger = open_ledger(model, after, true);
    const ObservedState at = after;
    ledger.integrator_coriolis = 0.1 * ledger.kinetic;
    Watch watch;
    warnings.clear();
    EXPECT_TRUE(guard_energy({model, scene, at.state, at.observation, control}, 0, after, ledger,
                             watch, warnings)
                    .ok());
    EXPECT_EQ(warnings.size(), 1u);
    EXPECT_EQ(after.state.qdot == moving.qdot, rule == TimeRule::midpoint);
    EXPECT_EQ(ledger.integrator_held == 0, rule == TimeRule::midpoint);
  }
}

TEST_F(EnergyWatch, OnlyWarnsWhereTheSceneAsksForIt) {
  EXPECT_GT(growth(EnergyAction::warn, 40), 1.1);
  ASSERT_EQ(warnings.size(), 1u);
  expect_told(warnings[0]);
}

TEST_F(EnergyWatch, StopsWhereTheSceneAsksForIt) {
  try {
    growth(EnergyAction::stop);
    ADD_FAILURE() << "no error";
  } catch (const StepError& error) {
    EXPECT_EQ(error.outcome(), Outcome::energy_gain);
    EXPECT_NE(std::string(error.what()).find("guard.energy_gain = 0.005"), std::string::npos);
  }
}

}  // namespace hagfish::guard_test
