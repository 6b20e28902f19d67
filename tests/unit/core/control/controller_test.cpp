// The controller: the contacts with which the knot begins and ends, when it goes from one phase to
// the next and what it commands in each, and what it says of a knot that does not come or comes
// undone.
#include <gtest/gtest.h>

#include "tests/unit/core/control/controller_fixture.hpp"

namespace hagfish::controller_test {

using Controller = ControllerTest;

TEST_F(Controller, HasNoSpanWithoutContacts) {
  step({});
  EXPECT_FALSE(knot_span(state));
  EXPECT_FALSE(state.ends.first || state.ends.last);
}

TEST_F(Controller, SpansFromTheFirstToTheLast) {
  step({contact(5, 30), contact(6, 33, 0.04), contact(8, 25)});
  ASSERT_TRUE(knot_span(state));
  EXPECT_EQ(knot_span(state)->head_end, 5);
  EXPECT_EQ(knot_span(state)->tail_end, 33);
}

TEST_F(Controller, DropsThemOnceNoneTouches) {
  step({contact(5, 30)});
  step({contact(5, 30, 0.08)});
  EXPECT_FALSE(state.ends.first || state.ends.last);
}

TEST_F(Controller, CommandsNoneThatDoNotTouch) {
  start_in(Phase::slide);
  EXPECT_TRUE(step({contact(5, 30, 0.08)}).thigmotaxis.empty());
}

TEST_F(Controller, FormsByScriptWithTheHeadClamped) {
  now = 2.5;
  const Control control = step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::form);
  EXPECT_TRUE(control.clamp_head);
  EXPECT_EQ(control.tip.value, Eigen::Vector3d(30, 40, 50));
  EXPECT_TRUE(control.thigmotaxis.empty());
}

TEST_F(Controller, TightensOnceTiedWithEnoughTailThrough) {
  tie(true);
  step({contact(5, 34.5)});  // 7.9 cm of tail
  EXPECT_EQ(state.phase, Phase::form);
  now = 1;
  const Control control = step({contact(5, 34.3)});  // 8.1 cm
  EXPECT_EQ(state.phase, Phase::tighten);
  EXPECT_EQ(state.phase_start, 1);
  EXPECT_EQ(control.tip.value, Eigen::Vector3d::Zero());
  EXPECT_TRUE(control.clamp_head);
  ASSERT_EQ(control.thigmotaxis.size(), 2U);
  EXPECT_EQ(control.thigmotaxis[0].contact.arc_a, 5);
  EXPECT_EQ(control.thigmotaxis[0].speed.a, 0);
  EXPECT_EQ(control.thigmotaxis[0].speed.b, 0);
  EXPECT_EQ(control.thigmotaxis[1].speed.a, 0.5);
  EXPECT_EQ(control.thigmotaxis[1].speed.b, 2);
}

TEST_F(Controller, LooksAtTheKnotOnlyNowAndThen) {
  tie(false);
  step({contact(5, 30)});  // checks the knot, and again in 10 ms
  tie(true);
  for (int k = 0; k < 4; ++k) {
    step({contact(5, 30)});
    ASSERT_EQ(state.phase, Phase::form) << k;
  }
  step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::tighten);
}

TEST_F(Controller, SlidesOnceTightForAWhile) {
  start_in(Phase::tighten);
  for (int round = 0; round < 3; ++round) {
    const double loose = now;
    step({contact(5, 25.4)});  // 20.4 cm, which restarts the wait
    while (now < loose + 0.1 - 1e-9) {
      step({contact(5.1, 25.3)});  // 20.2 cm
      ASSERT_EQ(state.phase, Phase::tighten) << now - loose;
    }
  }
  step({contact(5.1, 25.3)});  // the time of a step may fall short of tight_hold by rounding
  const Control control = step({contact(5.1, 25.3)});
  EXPECT_EQ(state.phase, Phase::slide);
  ASSERT_EQ(control.thigmotaxis.size(), 2U);
  for (const ThigmotaxisCommand& command : control.thigmotaxis) {
    EXPECT_EQ(command.speed.a, 2);
    EXPECT_EQ(command.speed.b, 2);
  }
}

TEST_F(Controller, SlidesAfterTheLongestTightening) {
  now = 20;
  start_in(Phase::tighten);
  step({contact(5, 30)});
  now = 21.99;
  step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::tighten);
  now = 22;
  step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::slide);
}

TEST_F(Controller, FreesTheHeadOnceTheKnotIsNear) {
  start_in(Phase::slide);
  EXPECT_TRUE(step({contact(1.95, 20)}).clamp_head);
  EXPECT_EQ(state.phase, Phase::slide);
  const Control control = step({contact(1.90, 20)});
  EXPECT_EQ(state.phase, Phase::release);
  EXPECT_FALSE(control.clamp_head);
  ASSERT_EQ(control.thigmotaxis.size(), 2U);
  EXPECT_EQ(control.thigmotaxis[0].speed.a, 2);
}

TEST_F(Controller, StopsOnceUntied) {
  start_in(Phase::release);
  tie(false);
  now = state.knot_seen + scene.knot.interval;
  const Control control = step({contact(1, 20)});
  EXPECT_EQ(state.phase, Phase::free);
  EXPECT_TRUE(control.thigmotaxis.empty());
  EXPECT_FALSE(control.clamp_head);
}

TEST_F(Controller, NeverClampsAHeadThatTheSceneLeavesFree) {
  scene.clamp_head = false;
  EXPECT_FALSE(step({}).clamp_head);
}

TEST_F(Controller, DoesNotTightenBeforeItsTime) {
  scene.controller.tighten_from = 4;
  tie(true);
  now = 3.98;
  step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::form);
  now = 4;
  step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::tighten);
}

TEST_F(Controller, FreesTheHeadFromThePhaseThatTheSceneNames) {
  scene.controller.free_from = Phase::tighten;
  tie(false);
  EXPECT_TRUE(step({contact(5, 30)}).clamp_head);
  start_in(Phase::tighten);
  EXPECT_FALSE(step({contact(5, 30)}).clamp_head);
  scene.controller.free_from = Phase::free;
  start_in(Phase::release);
  EXPECT_TRUE(step({contact(5, 30)}).clamp_head);
}

TEST_F(Controller, TurnsBackAtTheHeadAndReleasesNearTheTail) {
  scene.controller.leave_by = BodyEnd::tail;
  scene.controller.reverse_head = {3, 4};
  scene.controller.reverse_tail = {5, 6};
  start_in(Phase::slide);
  EXPECT_EQ(step({contact(1.95, 20)}).thigmotaxis.at(0).towards, BodyEnd::head);
  Control control = step({contact(1.9, 20)});
  EXPECT_EQ(state.phase, Phase::reverse);
  EXPECT_TRUE(control.clamp_head);
  ASSERT_EQ(control.thigmotaxis.size(), 2U);
  EXPECT_EQ(control.thigmotaxis[0].towards, BodyEnd::tail);
  EXPECT_EQ(control.thigmotaxis[0].speed.a, 3);
  EXPECT_EQ(control.thigmotaxis[1].speed.b, 6);
  // 1.908 cm before the tail's end, at 42.4 cm.
  step({contact(20, 40.48)});
  EXPECT_EQ(state.phase, Phase::reverse);
  control = step({contact(20, 40.5)});
  EXPECT_EQ(state.phase, Phase::release);
  EXPECT_EQ(control.thigmotaxis.at(1).towards, BodyEnd::tail);
  // Until then the knot must not come undone.
  start_in(Phase::reverse);
  tie(false);
  now = state.knot_seen + scene.knot.interval;
  EXPECT_THROW(step({contact(5, 30)}), StepError);
}

TEST_F(Controller, PullsAtFoodUntilItLetsGo) {
  scene.controller.cap = 400;
  scene.food.hold = 1;
  scene.food.cap = {100, 300, 0.5};
  start_in(Phase::slide);
  EXPECT_EQ(step({contact(1.95, 20)}).thigmotaxis.at(0).effort, 1);
  const double since = now;
  Control control = step({contact(1.9, 20)});
  EXPECT_EQ(state.phase, Phase::pull);
  EXPECT_TRUE(control.clamp_head);
  ASSERT_EQ(control.thigmotaxis.size(), 2U);
  for (const ThigmotaxisCommand& command : control.thigmotaxis) {
    EXPECT_EQ(command.speed.a, 2);
    EXPECT_EQ(command.towards, BodyEnd::head);
    EXPECT_EQ(command.effort, 0.25);
  }
  now = since + 0.25;
  EXPECT_NEAR(step({contact(1.9, 20)}).thigmotaxis.at(1).effort, 0.5, 1e-12);
  now = since + 0.75;
  EXPECT_EQ(step({contact(1.9, 20)}).thigmotaxis.at(1).effort, 0.75);
  now = since + 0.996;
  step({contact(1.9, 20)});
  EXPECT_EQ(state.phase, Phase::pull);
  now = since + 1;
  control = step({contact(1.9, 20)});
  EXPECT_EQ(state.phase, Phase::release);
  EXPECT_FALSE(control.clamp_head);
  EXPECT_EQ(control.thigmotaxis.at(0).effort, 1);
}

TEST_F(Controller, FoodGivesWhereTheMeanPullPassesItsStrength) {
  scene.food = {.hold = 1, .strength = 0.5, .average = 0.01, .cap = {100, 100, 0}};  // 5 steps
  now = 0.004;
  start_in(Phase::slide);
  StepSolution solution;
  const auto pull = [&](double newton) {
    step({contact(1.9, 20)});
    solution.force[RowKind::head] = Eigen::VectorXd::Zero(model.nv());
    solution.force[RowKind::head][0] = -newton * dyn_per_newton;
    note_pull(solution, state);
  };
  // From 0.004 to 0.01 s: a mean of the pull alone, but not over its whole time.
  for (int k = 0; k < 3; ++k) pull(2);
  // A step above, and a mean at the strength, are not enough.
  for (const double newton : {0.5, 0.6, 0.4, 0.5, 0.5}) pull(newton);
  for (const double newton : {0.5, 0.6, 0.4, 0.5, 0.51}) pull(newton);
  EXPECT_EQ(state.phase, Phase::pull);
  EXPECT_FALSE(step({contact(1.9, 20)}).clamp_head);
  EXPECT_EQ(state.phase, Phase::release);
  EXPECT_NEAR(now, 0.032, 1e-12);
}

TEST_F(Controller, AKnotIsGoneOnceItHasBeenForAWhile) {
  scene.controller.untied_for = 0.1;
  start_in(Phase::release);
  tie(false);
  now = state.knot_seen + scene.knot.interval;
  const double since = now;
  while (now < since + 0.1 - 1e-9) {
    step({contact(1, 20)});
    ASSERT_EQ(state.phase, Phase::release) << now - since;
  }
  tie(true);  // back for a moment: the wait restarts
  now = state.knot_seen + scene.knot.interval;
  step({contact(1, 20)});
  tie(false);
  now = state.knot_seen + scene.knot.interval;
  step({contact(1, 20)});
  EXPECT_EQ(state.phase, Phase::release);
  now += 0.1;
  step({contact(1, 20)});
  EXPECT_EQ(state.phase, Phase::free);
}

TEST_F(Controller, ThrowsWhereTheScriptEndsUntied) {
  tie(false);
  now = 6.9;  // the script ends at 5 s, and two fifths of that is patience
  EXPECT_NO_THROW(step({}));
  now = 7.1;
  EXPECT_EQ(complaint({}),
            "the script ended with no knot (none was tied before), but expect.knot = 3_1");
}

TEST_F(Controller, TellsWhichKnotCameUndoneAndWhen) {
  tie(true);
  now = 3;
  step({});
  tie(false);
  now = 4.5;
  step({});
  now = 7.1;
  EXPECT_EQ(complaint({}),
            "the script ended with no knot (there was a knot (overhand, 3_1) from 3.00 to 4.50 s), "
            "but expect.knot = 3_1");
}

TEST_F(Controller, WaitsForTheScenesKnotAndTellsWhichOneCame) {
  scene.expect.knot = "4_1";
  tie(true);
  now = 3;
  step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::form);
  now = 7.1;
  EXPECT_EQ(
      complaint({contact(5, 30)}),
      "the script ended with a knot (overhand, 3_1), tied since 3.00 s, but expect.knot = 4_1");
}

TEST_F(Controller, TellsOfTooLittleTailThrough) {
  tie(true);
  now = 3;
  step({contact(5, 35)});
  now = 7.1;
  EXPECT_EQ(complaint({contact(5, 35)}),
            "the script ended with a knot (overhand, 3_1), tied since 3.00 s, but only 7.40 cm of "
            "tail is through "
            "it; controller.tail_through = 8 cm");
}

TEST_F(Controller, ThrowsWhereTheKnotIsLost) {
  for (const Phase phase : {Phase::tighten, Phase::slide}) {
    start_in(phase);
    tie(false);
    now = state.knot_seen + scene.knot.interval;
    EXPECT_THROW(step({contact(5, 30)}), StepError) << phase_name(phase);
  }
}

TEST_F(Controller, WaitsWithoutAScript) {
  scene.script = {};
  tie(false);
  now = 1000;
  EXPECT_NO_THROW(step({}));
  EXPECT_EQ(state.phase, Phase::form);
}

TEST_F(Controller, WithoutAKnotExpectedItOnlyForms) {
  scene.expect.knot = "";
  tie(true);
  now = 100;
  EXPECT_EQ(complaint({contact(5, 30)}), "none");
  EXPECT_EQ(state.phase, Phase::form);
}

}  // namespace hagfish::controller_test
