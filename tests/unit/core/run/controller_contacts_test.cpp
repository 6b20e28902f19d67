// Which contacts the controller takes for the first and the last of the knot, and for how long.
#include <gtest/gtest.h>

#include "tests/support/controller_fixture.hpp"

namespace hagfish::controller_contacts_test {

using ControllerContacts = ControllerTest;

TEST_F(ControllerContacts, HasNoSpanWithoutContacts) {
  step({});
  EXPECT_FALSE(knot_span(state));
  EXPECT_FALSE(state.first.contact || state.last.contact);
}

TEST_F(ControllerContacts, FindsTheOutermostTouchingContacts) {
  // The last contact is the one whose later strand is nearest the tail, not the last in the list.
  step({contact(2, 20, 0.06), contact(5, 30), contact(6, 33, 0.04), contact(8, 25),
        contact(9, 40, 0.051)});
  EXPECT_EQ(first(), 5);
  EXPECT_EQ(last(), 33);
  ASSERT_TRUE(knot_span(state));
  EXPECT_EQ(knot_span(state)->head_end, 5);
  EXPECT_EQ(knot_span(state)->tail_end, 33);
}

TEST_F(ControllerContacts, KeepsAContactUntilARivalHasBeenOutermostLongEnough) {
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

TEST_F(ControllerContacts, ARivalThatGoesAwayWaitsAgain) {
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

TEST_F(ControllerContacts, FollowsAContactThatSlides) {
  double arc = 10;
  step({contact(arc, 30)});
  for (int k = 0; k < 500; ++k) {
    arc -= 0.01;
    step({contact(arc, 30)});
    ASSERT_EQ(first(), arc);
  }
  // Also past a rival's time: the contact is where it is now.
  for (int k = 0; k < 10; ++k) {
    arc -= 0.01;
    step({contact(1, 20), contact(arc, 30)});
    ASSERT_EQ(first(), arc);
  }
}

TEST_F(ControllerContacts, KeepsAContactThatOpensWithinTheMargin) {
  step({contact(5, 30), contact(7, 28)});
  step({contact(5, 30, 0.08), contact(7, 28)});
  EXPECT_EQ(first(), 5);
}

TEST_F(ControllerContacts, KeepsThePointsOfAContactThatIsGoneForTheSameTime) {
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

TEST_F(ControllerContacts, DropsThemOnceNoneTouches) {
  step({contact(5, 30)});
  step({contact(5, 30, 0.08)});
  EXPECT_FALSE(state.first.contact || state.last.contact);
}

TEST_F(ControllerContacts, CommandsNoneThatDoNotTouch) {
  start_in(Phase::slide);
  EXPECT_TRUE(step({contact(5, 30, 0.08)}).thigmotaxis.empty());
}

}  // namespace hagfish::controller_contacts_test
