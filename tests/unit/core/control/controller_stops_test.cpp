// What the controller says of a knot that does not come, or comes undone.
#include <gtest/gtest.h>

#include "tests/support/controller_fixture.hpp"

namespace hagfish::controller_stops_test {

using ControllerStops = ControllerTest;

TEST_F(ControllerStops, ThrowsWhereTheScriptEndsUntied) {
  tie(false);
  now = 6.9;  // the script ends at 5 s, and two fifths of that is patience
  EXPECT_NO_THROW(step({}));
  now = 7.1;
  EXPECT_EQ(complaint({}),
            "the script ended with no knot (none was tied before), but expect.knot = 3_1");
}

TEST_F(ControllerStops, TellsWhichKnotCameUndoneAndWhen) {
  tie(true);
  now = 3;
  step({});
  tie(false);
  now = 4.5;
  step({});
  now = 7.1;
  EXPECT_EQ(
      complaint({}),
      "the script ended with no knot (there was a 3_1 from 3.00 to 4.50 s), but expect.knot = 3_1");
}

TEST_F(ControllerStops, WaitsForTheScenesKnotAndTellsWhichOneCame) {
  scene.expect.knot = "4_1";
  tie(true);
  now = 3;
  step({contact(5, 30)});
  EXPECT_EQ(state.phase, Phase::form);
  now = 7.1;
  EXPECT_EQ(complaint({contact(5, 30)}),
            "the script ended with a 3_1, tied since 3.00 s, but expect.knot = 4_1");
}

TEST_F(ControllerStops, TellsOfTooLittleTailThrough) {
  tie(true);
  now = 3;
  step({contact(5, 35)});
  now = 7.1;
  EXPECT_EQ(complaint({contact(5, 35)}),
            "the script ended with a 3_1, tied since 3.00 s, but only 7.40 cm of tail is through "
            "it; controller.tail_through = 8 cm");
}

TEST_F(ControllerStops, ThrowsWhereTheKnotIsLost) {
  for (const Phase phase : {Phase::tighten, Phase::slide}) {
    start_in(phase);
    tie(false);
    now = state.knot_seen + scene.knot.interval;
    EXPECT_THROW(step({contact(5, 30)}), StepError) << phase_name(phase);
  }
}

TEST_F(ControllerStops, WaitsWithoutAScript) {
  scene.script = {};
  tie(false);
  now = 1000;
  EXPECT_NO_THROW(step({}));
  EXPECT_EQ(state.phase, Phase::form);
}

TEST_F(ControllerStops, WithoutAKnotExpectedItOnlyForms) {
  scene.expect.knot = "";
  tie(true);
  now = 100;
  EXPECT_EQ(complaint({contact(5, 30)}), "none");
  EXPECT_EQ(state.phase, Phase::form);
}

}  // namespace hagfish::controller_stops_test
