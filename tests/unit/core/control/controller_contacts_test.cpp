// The controller and the contacts with which the knot begins and ends.
#include <gtest/gtest.h>

#include "tests/support/controller_fixture.hpp"

namespace hagfish::controller_contacts_test {

using ControllerContacts = ControllerTest;

TEST_F(ControllerContacts, HasNoSpanWithoutContacts) {
  step({});
  EXPECT_FALSE(knot_span(state));
  EXPECT_FALSE(state.ends.first || state.ends.last);
}

TEST_F(ControllerContacts, SpansFromTheFirstToTheLast) {
  step({contact(5, 30), contact(6, 33, 0.04), contact(8, 25)});
  ASSERT_TRUE(knot_span(state));
  EXPECT_EQ(knot_span(state)->head_end, 5);
  EXPECT_EQ(knot_span(state)->tail_end, 33);
}

TEST_F(ControllerContacts, DropsThemOnceNoneTouches) {
  step({contact(5, 30)});
  step({contact(5, 30, 0.08)});
  EXPECT_FALSE(state.ends.first || state.ends.last);
}

TEST_F(ControllerContacts, CommandsNoneThatDoNotTouch) {
  start_in(Phase::slide);
  EXPECT_TRUE(step({contact(5, 30, 0.08)}).thigmotaxis.empty());
}

}  // namespace hagfish::controller_contacts_test
