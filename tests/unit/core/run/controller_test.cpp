// Phases and contact identity on made-up observations: the controller sees contacts and centres,
// and neither needs to come from a simulation here.
#include "core/run/controller.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/random_chain.hpp"

namespace hagfish {
namespace {

Contact contact(double arc_a, double arc_b, double gap = 0) {
  Contact c;
  c.arc_a = arc_a;
  c.arc_b = arc_b;
  c.segment_a = static_cast<int>(arc_a / 0.424);
  c.segment_b = static_cast<int>(arc_b / 0.424);
  c.gap = gap;
  c.normal = Eigen::Vector3d::UnitX();
  c.tangent_a = Eigen::Vector3d::UnitY();
  c.tangent_b = Eigen::Vector3d::UnitZ();
  return c;
}

class Controller : public testing::Test {
 protected:
  Scene scene = table1_scene();
  Model model = table1_hagfish();
  ControllerState state;
  Observation observation;
  double now = 0;

  Controller() {
    scene.expect.knot = "3_1";
    scene.script.kind = ScriptSettings::Kind::force;
    scene.script.knots = {{0, {10, 20, 30}}, {5, {50, 60, 70}}};
    scene.controller.hysteresis = 0.05;
    scene.controller.contact_gap = 0.05;
    scene.controller.tail_through = 8;
    scene.controller.tight_span = 20.352;
    scene.controller.tight_hold = 0.1;
    scene.controller.tighten_time = 2;
    scene.controller.release_at = 1.908;
    scene.knot.interval = 0.01;
    scene.time.step = 0.002;
    observation.kin = kinematics(model, rest_state(model));
    observation.segments = spline(model, observation.kin.centre);
  }

  /// Centres on an open overhand knot or on a line.
  void tie(bool knotted) {
    for (int b = 0; b < model.body_count(); ++b) {
      const double t = (b + 0.5) / model.body_count();
      observation.kin.centre.col(b) =
          knotted ? trefoil_point(t, 2.45) : Eigen::Vector3d(42.4 * t, 0, 0);
    }
  }

  Control step(std::vector<Contact> contacts) {
    observation.contact.contacts = std::move(contacts);
    Control control;
    const Status status = decide(model, scene, observation, now, state, control);
    if (!status.ok()) throw StepError(status);
    now += scene.time.step;
    return control;
  }

  /// In `phase` with a knot that spans 5 to 30 cm.
  void start_in(Phase phase) {
    tie(true);
    state.phase = phase;
    state.phase_start = now;
    state.loose = now;
    state.knot = knot_type(observation.kin.centre, scene.knot);
    state.knot_seen = now;
  }

  /// What the controller complains of at a step.
  std::string complaint(std::vector<Contact> contacts) {
    try {
      step(std::move(contacts));
    } catch (const StepError& error) {
      return error.what();
    }
    return "none";
  }

  double first() const { return state.first.contact->arc_a; }
  double last() const { return state.last.contact->arc_b; }
};

TEST_F(Controller, TrefoilOfTheseTestsIsOne) {
  tie(true);
  EXPECT_EQ(knot_type(observation.kin.centre, {.votes = 15, .seed = 1}).type,
            (KnotInvariants{3, 1}));
}

TEST_F(Controller, HasNoSpanWithoutContacts) {
  step({});
  EXPECT_FALSE(knot_span(state));
  EXPECT_FALSE(state.first.contact || state.last.contact);
}

TEST_F(Controller, FindsTheOutermostTouchingContacts) {
  // The last contact is the one whose later strand is nearest the tail, not the last in the list.
  step({contact(2, 20, 0.06), contact(5, 30), contact(6, 33, 0.04), contact(8, 25),
        contact(9, 40, 0.051)});
  EXPECT_EQ(first(), 5);
  EXPECT_EQ(last(), 33);
  ASSERT_TRUE(knot_span(state));
  EXPECT_EQ(knot_span(state)->head_end, 5);
  EXPECT_EQ(knot_span(state)->tail_end, 33);
}

TEST_F(Controller, KeepsAContactUntilARivalHasBeenOutermostLongEnough) {
  const double since = now;
  step({contact(5, 30)});
  const std::vector<Contact> rivalled = {contact(4, 20), contact(5, 30)};
  while (now < since + 0.05 - 1e-9) {
    step(rivalled);
    ASSERT_EQ(first(), 5) << now - since;
  }
  step(rivalled);
  step(rivalled);  // the time of a step may fall short of the hysteresis by rounding
  EXPECT_EQ(first(), 4);
  EXPECT_EQ(last(), 30);
}

TEST_F(Controller, ARivalThatGoesAwayStartsAnew) {
  step({contact(5, 30)});
  for (int round = 0; round < 5; ++round) {
    for (int k = 0; k < 20; ++k) {  // 40 ms of 50
      step({contact(4, 20), contact(5, 30)});
      ASSERT_EQ(first(), 5);
    }
    step({contact(5, 30)});
    ASSERT_EQ(first(), 5);
  }
}

TEST_F(Controller, FollowsAContactThatSlides) {
  double arc = 10;
  step({contact(arc, 30)});
  for (int k = 0; k < 500; ++k) {
    arc -= 0.01;
    step({contact(arc, 30)});
    ASSERT_EQ(first(), arc);
  }
  // Also past a rival's time: what it holds is the contact where it is now.
  for (int k = 0; k < 10; ++k) {
    arc -= 0.01;
    step({contact(1, 20), contact(arc, 30)});
    ASSERT_EQ(first(), arc);
  }
}

TEST_F(Controller, KeepsAContactThatOpensWithinTheMargin) {
  step({contact(5, 30), contact(7, 28)});
  step({contact(5, 30, 0.08), contact(7, 28)});
  EXPECT_EQ(first(), 5);
}

TEST_F(Controller, HoldsThePointsOfAContactThatIsGoneForTheSameTime) {
  const double since = now;
  const Contact gone = contact(5, 30);
  step({gone, contact(7, 28)});
  while (now < since + 0.05 - 1e-9) {
    step({contact(7, 28)});
    ASSERT_TRUE(state.first.contact);
    ASSERT_EQ(state.first.contact->segment_a, gone.segment_a);
    ASSERT_EQ(state.first.contact->segment_b, gone.segment_b);
    // As it is now: these bodies lie on a line.
    ASSERT_EQ(state.first.contact->tangent_a, Eigen::Vector3d::UnitX());
    ASSERT_EQ(state.last.contact->segment_b, gone.segment_b);
  }
  step({contact(7, 28)});
  step({contact(7, 28)});
  EXPECT_EQ(first(), 7);
  EXPECT_EQ(last(), 28);
}

TEST_F(Controller, LetsGoOnceNoneTouches) {
  step({contact(5, 30)});
  step({contact(5, 30, 0.08)});
  EXPECT_FALSE(state.first.contact || state.last.contact);
}

TEST_F(Controller, FormsByScriptWithTheHeadHeld) {
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

TEST_F(Controller, DoesNotTightenAnUnknot) {
  tie(false);
  step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::form);
}

TEST_F(Controller, LooksAtTheKnotOnlyNowAndThen) {
  tie(false);
  step({contact(5, 30)});  // looks, and again in 10 ms
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
    step({contact(5, 25.4)});  // 20.4 cm, which starts the wait anew
    while (now < loose + 0.1 - 1e-9) {
      step({contact(5.1, 25.3)});  // 20.2 cm
      ASSERT_EQ(state.phase, Phase::tighten) << now - loose;
    }
  }
  step({contact(5.1, 25.3)});  // the time of a step may fall short of the hold by rounding
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

TEST_F(Controller, ThrowsWhereTheScriptEndsUntied) {
  tie(false);
  now = 6.9;  // the script ends at 5 s; patience is 2 s
  EXPECT_NO_THROW(step({}));
  now = 7.1;
  EXPECT_EQ(complaint({}),
            "the script ended with no knot, and tied none before, but expect.knot = 3_1");
}

TEST_F(Controller, TellsWhichKnotCameUndoneAndWhen) {
  tie(true);
  now = 3;
  step({});
  tie(false);
  now = 4.5;
  step({});
  now = 7.1;
  EXPECT_EQ(
      complaint({}),
      "the script ended with no knot, after a 3_1 from 3.00 to 4.50 s, but expect.knot = 3_1");
}

TEST_F(Controller, WaitsForTheScenesKnotAndTellsWhichOneCame) {
  scene.expect.knot = "4_1";
  tie(true);
  now = 3;
  step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::form);
  now = 7.1;
  EXPECT_EQ(complaint({contact(5, 30)}),
            "the script ended with a 3_1, tied since 3.00 s, but expect.knot = 4_1");
}

TEST_F(Controller, TellsOfTooLittleTailThrough) {
  tie(true);
  now = 3;
  step({contact(5, 35)});
  now = 7.1;
  EXPECT_EQ(complaint({contact(5, 35)}),
            "the script ended with a 3_1, tied since 3.00 s, but 7.40 cm of tail through it where "
            "controller.tail_through = 8 cm");
}

TEST_F(Controller, WithoutAKnotExpectedItOnlyForms) {
  scene.expect.knot = "";
  tie(true);
  now = 100;
  EXPECT_EQ(complaint({contact(5, 30)}), "none");
  EXPECT_EQ(state.phase, Phase::form);
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

TEST_F(Controller, TurnsBackAtTheHeadAndLetsGoNearTheTail) {
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
  now += scene.controller.hysteresis;
  step({contact(20, 40.48)});
  EXPECT_EQ(state.phase, Phase::reverse);
  control = step({contact(20, 40.5)});
  EXPECT_EQ(state.phase, Phase::release);
  EXPECT_EQ(control.thigmotaxis.at(1).towards, BodyEnd::tail);
  // Until then the knot must hold.
  start_in(Phase::reverse);
  tie(false);
  now = state.knot_seen + scene.knot.interval;
  EXPECT_THROW(step({contact(5, 30)}), StepError);
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
  tie(true);  // back for a moment: the wait starts anew
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

TEST_F(Controller, WaitsWithoutAScript) {
  scene.script = {};
  tie(false);
  now = 1000;
  EXPECT_NO_THROW(step({}));
  EXPECT_EQ(state.phase, Phase::form);
}

TEST_F(Controller, ThrowsWhereTheKnotIsLost) {
  for (const Phase phase : {Phase::tighten, Phase::slide}) {
    start_in(phase);
    tie(false);
    now = state.knot_seen + scene.knot.interval;
    EXPECT_THROW(step({contact(5, 30)}), StepError) << phase_name(phase);
  }
}

TEST_F(Controller, SaysNothingToAKnotThatDoesNotTouch) {
  start_in(Phase::slide);
  EXPECT_TRUE(step({contact(5, 30, 0.08)}).thigmotaxis.empty());
}

TEST(Phase, HasAnOrderInTime) {
  const std::vector<Phase> order = {Phase::form,    Phase::tighten, Phase::slide,
                                    Phase::reverse, Phase::release, Phase::free};
  for (std::size_t k = 0; k < order.size(); ++k) {
    EXPECT_EQ(phase_order(order[k]), static_cast<int>(k));
    EXPECT_EQ(holds_knot(order[k]), k >= 1 && k <= 3) << phase_name(order[k]);
  }
  // Logs hold these numbers.
  EXPECT_EQ(static_cast<int>(Phase::free), 4);
  EXPECT_EQ(static_cast<int>(Phase::reverse), 5);
}

TEST(Phase, HasNames) {
  EXPECT_STREQ(phase_name(Phase::form), "form");
  EXPECT_STREQ(phase_name(Phase::release), "release");
  EXPECT_STREQ(phase_name(Phase::free), "free");
}

}  // namespace
}  // namespace hagfish
