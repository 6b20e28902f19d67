// Control laws: what they ask for, by hand; laws and controls that do not fit are refused.
#include "core/control/control_law.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/run/guard.hpp"
#include "tests/support/errors.hpp"
#include "tests/unit/core/control/controller_fixture.hpp"

namespace hagfish::control_law_test {

class ControlLaws : public ControllerTest {
 protected:
  ControlLaws() {
    start_in(Phase::slide);
    scene.controller.slide_head = {2, 3};
    scene.controller.slide_tail = {4, 5};
  }
  /// Touching, with tangents at an angle (rad).
  static Contact crossing(double arc_a, double arc_b, double angle, double gap = 0) {
    Contact c = contact(arc_a, arc_b, gap);
    c.tangent_b = {0, std::cos(angle), std::sin(angle)};  // tangent_a is along Y
    return c;
  }
  /// Both strands run along themselves at `speed`: the left sides of Eq. 6 of that motion.
  void expect_slip(const ThigmotaxisCommand& command, const ThigmotaxisSpeeds& speed) {
    const Contact& at = command.contact;
    const Eigen::Vector3d apart = speed.a * at.tangent_a - speed.b * at.tangent_b;
    const auto rows =
        eq6_rows(model, observation.kin, spline(model, observation.kin.centre), command, scene);
    EXPECT_NEAR(rows[0].rhs, at.tangent_a.dot(apart), 1e-12);
    EXPECT_NEAR(rows[1].rhs, at.tangent_b.dot(-apart), 1e-12);
  }
  std::string refusal() {
    return error_of<std::invalid_argument>([&] { check_control(model, control); });
  }
  Control control;
};

TEST_F(ControlLaws, ThePaperCommandsTheEndsOfTheKnot) {
  const Control c = step({contact(5, 20), contact(9, 30), contact(12, 25)});
  ASSERT_EQ(c.thigmotaxis.size(), 2u);
  EXPECT_EQ(c.thigmotaxis[0].end, KnotEnd::first);
  EXPECT_EQ(c.thigmotaxis[0].contact.arc_a, 5);
  EXPECT_EQ(c.thigmotaxis[1].end, KnotEnd::last);
  EXPECT_EQ(c.thigmotaxis[1].contact.arc_b, 30);
}

TEST_F(ControlLaws, AllContactsAskWhatAKnotOfConstantShapeGives) {
  scene.controller.law = "all_contacts";
  const double angle = 0.7;
  const Control c = step({contact(5, 20), crossing(7, 22, angle), crossing(8, 23, angle, 0.06),
                          contact(9, 30), crossing(12, 25, M_PI)});
  ASSERT_EQ(c.thigmotaxis.size(), 4u);  // one of five does not touch
  for (const std::size_t k : {std::size_t{2}, std::size_t{3}}) {
    const ThigmotaxisCommand& other = c.thigmotaxis[k];
    EXPECT_EQ(other.end, KnotEnd::neither);
    expect_slip(other, {2, 3});
  }
  start_in(Phase::tighten);
  EXPECT_EQ(step({contact(5, 20), crossing(7, 22, angle), contact(9, 30)}).thigmotaxis.size(), 2u);
}

TEST_F(ControlLaws, EqSixAsksForTheSlipOfStrandsThatRunAlongThemselves) {
  scene.controller.eq6_slip = Eq6Slip::shape;
  for (const double angle : {0.01, 0.7, M_PI / 2, 3.0}) {
    const Control c = step({crossing(5, 20, angle), crossing(12, 25, -angle)});
    ASSERT_EQ(c.thigmotaxis.size(), 2u);
    expect_slip(c.thigmotaxis[0], {2, 3});
    expect_slip(c.thigmotaxis[1], {4, 5});
  }
  // At one speed v: 0 side by side, v at right angles, 2 v where strands run past each other.
  for (const auto& [angle, share] : {std::pair(0.0, 0.0), {M_PI / 2, 1.0}, {M_PI, 2.0}}) {
    const ThigmotaxisSpeeds slip = slip_of_shape(std::cos(angle), {2, 2});
    EXPECT_NEAR(slip.a, 2 * share, 1e-12);
    EXPECT_NEAR(slip.b, 2 * share, 1e-12);
  }
  start_in(Phase::tighten);
  scene.controller.tighten_tail = {0.5, 2};
  const Control c = step({crossing(5, 20, 1), crossing(12, 25, 1)});
  expect_slip(c.thigmotaxis.at(0), {0, 0});
  expect_slip(c.thigmotaxis.at(1), {0.5, 2});
}

/// A helix slides along itself as a screw turns, of constant shape. The rows at any two of its
/// points have what Eq. 6 is asked for, but for how far a spline through points 0.4 cm apart on a
/// circle of 2 cm is off: 0.1 %.
TEST_F(ControlLaws, AHelixThatSlidesAlongItselfMeetsTheRows) {
  const double radius = 2, rise = 0.3, v = 1.5;  // cm, cm/rad, cm/s
  const double way = std::hypot(radius, rise);   // cm/rad
  Eigen::Matrix3Xd velocity(3, model.body_count());
  for (int b = 0; b < model.body_count(); ++b) {
    const double angle = 0.424 * b / way;
    observation.kin.centre.col(b) << rise * angle, radius * std::cos(angle),
        radius * std::sin(angle);
    velocity.col(b) << rise, -radius * std::sin(angle), radius * std::cos(angle);
  }
  velocity *= v / way;
  const std::vector<SplineSegment> segments = spline(model, observation.kin.centre);
  for (int b = 20; b < 70; ++b) {
    const Contact pair = contact_at(segments, 10, 0.3, b, 0.6);
    const ThigmotaxisSpeeds slip = slip_of_shape(pair.tangent_a.dot(pair.tangent_b), {v, v});
    for (const bool on_a : {true, false}) {
      const Row row = eq6_row(model, observation.kin, segments, pair, on_a, BodyEnd::head,
                              Eq6Point::centreline);
      const Matrix6Xd still = Matrix6Xd::Zero(6, model.body_count());
      EXPECT_NEAR(row_velocity(row, {still, velocity}, {}), on_a ? slip.a : slip.b, 2e-3 * v) << b;
    }
  }
}

/// A knot that slides at `share` of the speed that it is told settles at the target as the
/// first-order loop does: s = 1/share + (1 - 1/share) exp(-gain share t).
TEST_F(ControlLaws, KnotSpeedSettlesAtItsTarget) {
  const double target = 2, share = 1.6;
  scene.controller.law = "knot_speed";
  scene.controller.knot_speed = {target, 0.5, 0.01, 3};
  scene.controller.release_at = 0.1;
  double arc = 30;
  double scale = 1;
  for (int k = 0; k < 3000; ++k) {
    const double t = now;
    const Control c = step({contact(arc, 35)});
    scale = c.thigmotaxis.at(0).speed.a / 2;
    EXPECT_EQ(c.thigmotaxis.at(1).speed.b, 5 * scale);
    // The filter, which begins with the target's speed, lags by 10 ms, the command by a step.
    const double wanted = 1 / share + (1 - 1 / share) * std::exp(-0.5 * share * t);
    ASSERT_NEAR(scale, wanted, t < 5 ? 0.006 : 0.0002) << t;
    arc -= share * scale * target * scene.time.step;
  }
  // A knot that does not move has all that there is, one that runs away nothing.
  for (int k = 0; k < 4000; ++k) step({contact(arc, 35)});
  EXPECT_EQ(step({contact(arc, 35)}).thigmotaxis.at(0).speed.a, 2 * 3);
  for (int k = 0; k < 180; ++k) step({contact(arc -= 0.08, 35)});
  EXPECT_EQ(step({contact(arc, 35)}).thigmotaxis.at(0).speed.a, 0);
}

TEST_F(ControlLaws, KnotSpeedIsMeasuredByTheShortestFilter) {
  scene.controller.law = "knot_speed";
  scene.controller.release_at = 0.1;
  for (const double filter : {1e-3, 1e-5, 1e-9}) {
    state = {};
    start_in(Phase::slide);
    scene.controller.knot_speed = {2, 0.5, filter, 3};
    double arc = 30;
    Control c;
    for (int k = 0; k < 50; ++k) c = step({contact(arc -= 2 * scene.time.step, 35)});
    EXPECT_NEAR(c.thigmotaxis.at(0).speed.a, 2, 1e-3) << filter;  // it slides at its target
  }
}

TEST_F(ControlLaws, EveryLawForgetsAMemoryThatIsNotAsLongAsItsOwn) {
  scene.controller.reduced_basis.cosines = 2;
  for (const Law* law : laws()) {
    scene.controller.law = law->name;
    EXPECT_TRUE(fits_law(model, scene, {})) << law->name;
    EXPECT_EQ(fits_law(model, scene, Eigen::VectorXd::Zero(1)), law->name == own_law) << law->name;
  }
}

TEST_F(ControlLaws, TheRunsOwnHasAMemoryAndIsAskedForEachStep) {
  scene.controller.law = own_law;
  const ControlLaw own = [&](const Situation& at, Eigen::VectorXd& memory, Control& c) {
    EXPECT_EQ(c.thigmotaxis.size(), 0u);
    EXPECT_EQ(c.tip.value, Eigen::Vector3d::Zero());
    EXPECT_TRUE(c.clamp_head);
    memory.conservativeResize(memory.size() + 1);
    memory[memory.size() - 1] = at.time;
    c.torque.value = c.torque.rate = Eigen::VectorXd::Zero(at.model.nv());
    c.torque.value[9] = 7;
    c.rest_shape = c.torque.value / 70;
  };
  scene.active = {100, 1, 1, 1e6};
  observation.contact.contacts = {contact(5, 30)};
  for (const double time : {0.0, 0.002, 0.004}) {
    ASSERT_TRUE(decide(model, scene, seen, time, named, state, control, own).ok());
    EXPECT_EQ(control.torque.value[9], 7);
    EXPECT_EQ(control.rest_shape[9], 0.1);
    const ActiveTorque towards = active_torque(model, scene, seen.state, control.rest_shape);
    EXPECT_EQ(control.active.value, towards.value);
    EXPECT_GT(control.active.value[9], 0);
  }
  EXPECT_EQ(state.memory, Eigen::Vector3d(0, 0.002, 0.004));
}

TEST_F(ControlLaws, ATorqueWorksByItsValueAlone) {
  scene.controller.law = own_law;
  const ControlLaw own = [](const Situation& at, Eigen::VectorXd&, Control& c) {
    c.torque.value = 7 * Eigen::VectorXd::Unit(at.model.nv(), 9);
  };
  observation.contact.contacts = {contact(5, 30)};
  for (int k = 0; k < 2; ++k) {
    ASSERT_TRUE(decide(model, scene, seen, now, named, state, control, own).ok());
    EXPECT_EQ(control.torque.value[9], 7);
    EXPECT_EQ(control.torque.rate, Eigen::VectorXd::Zero(model.nv()));
  }
}

// Muscles have no more than their capacity, whoever asks, where the scene says so.
TEST_F(ControlLaws, TheCapacityBoundsTorquesOfLawsWhereTheSceneSaysSo) {
  scene.controller.law = own_law;
  scene.active = {100, 1, 1, 50};
  const ControlLaw own = [](const Situation& at, Eigen::VectorXd&, Control& c) {
    c.torque.value = c.torque.rate = Eigen::VectorXd::Zero(at.model.nv());
    c.torque.value[9] = -80;
    c.torque.rate[9] = 3;
    c.torque.value[11] = 40;
    c.rest_shape = 0.02 * Eigen::VectorXd::Unit(at.model.nv(), 11);
  };
  observation.contact.contacts = {contact(5, 30)};
  ASSERT_TRUE(decide(model, scene, seen, now, named, state, control, own).ok());
  EXPECT_EQ(control.torque.value[9], -80);
  EXPECT_EQ(control.torque.saturated, -1);
  scene.active.bounds_laws = true;
  ASSERT_TRUE(decide(model, scene, seen, now, named, state, control, own).ok());
  EXPECT_EQ(control.torque.value[9], -50);
  EXPECT_EQ(control.torque.rate[9], 0);
  EXPECT_EQ(control.torque.saturated, 9);
  // With what pulls to the rest shape it is no more than that, either.
  ASSERT_GT(control.active.value[11], 10);
  EXPECT_DOUBLE_EQ(control.active.value[11] + control.torque.value[11], 50);
  Watch watch;
  std::vector<std::string> warnings;
  guard_muscles(model, scene, control, 1, watch, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find(dof_name(model, 9) + " needs more torque than active.capacity = 50"),
            0u)
      << warnings[0];
}

TEST_F(ControlLaws, LawAndSceneMustAgree) {
  const auto complaint_of = [&](const ControlLaw& own) {
    return error_of<std::invalid_argument>(
        [&] { static_cast<void>(decide(model, scene, seen, now, named, state, control, own)); });
  };
  observation.contact.contacts = {contact(5, 30)};
  const ControlLaw own = [](const Situation&, Eigen::VectorXd&, Control&) {};
  EXPECT_NE(complaint_of(own).find("controller.law must be \"own\""), std::string::npos);
  scene.controller.law = own_law;
  EXPECT_NE(complaint_of({}).find("must set a control law"), std::string::npos);
}

TEST_F(ControlLaws, AControlThatIsNoneIsRefusedByName) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(), "no error");
  const auto expect = [&](const char* part) {
    EXPECT_NE(refusal().find(part), std::string::npos) << refusal();
    control = {};
  };
  control.rest_shape.setZero(7);
  expect("rest_shape has 7 numbers");
  control.torque.value.setZero(model.nv());
  expect("torque and torque's rate differ in length");
  control.torque.value = control.torque.rate = Eigen::VectorXd::Unit(model.nv(), 3);
  expect("torque acts on the root");
  control.torque.value = control.torque.rate = nan * Eigen::VectorXd::Ones(model.nv());
  expect("not finite");
  control.torque.value = control.torque.rate = -Eigen::VectorXd::Unit(model.nv(), 8);
  expect("rate is negative");
  control.tip.rate = -1;
  expect("rate is negative");
  control.tip.value.x() = nan;
  expect("tip force is not finite");
  const Contact there = contact(5, 30);
  control.thigmotaxis = {{there, {1, nan}}};
  expect("speeds 1 and nan");
  control.thigmotaxis = {{there, {1, 1}, BodyEnd::head, -0.5}};
  expect("effort -0.5 must be finite");
  control.thigmotaxis = {{there, {1, 1}}, {there, {2, 2}}};
  expect("two commands of Eq. 6 are at bodies 11 and 70");
  control.thigmotaxis = {{there, {1, 1}, BodyEnd::head, 1, KnotEnd::last},
                         {contact(7, 20), {2, 2}, BodyEnd::head, 1, KnotEnd::last}};
  expect("at one end of the knot");
  control.thigmotaxis = {{there, {1, 1}}};
  control.thigmotaxis[0].contact.segment_b = model.body_count() - 1;
  expect("not on the body");
  // The knot's ends and another command may share a contact.
  control.thigmotaxis = {{there, {1, 1}, BodyEnd::head, 1, KnotEnd::first},
                         {there, {1, 1}, BodyEnd::head, 1, KnotEnd::last},
                         {there, {1, 1}}};
  EXPECT_EQ(refusal(), "no error");
}

}  // namespace hagfish::control_law_test
