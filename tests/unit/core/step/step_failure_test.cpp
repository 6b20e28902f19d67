// Steps that cannot be solved say why.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/support/step_stage.hpp"

namespace hagfish::step_failure_test {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

TEST(Step, NamesRowsThatContradictEachOther) {
  // The clamp holds a head that the plate, without a neck to let it through, wants to push out.
  for (const std::string& name : box_qp_solver_names()) {
    Stage s;
    s.model.obstacles.at(0).shape = Plane{.neck = 0};
    s.solver = StepSolver(name);
    const Observation now = observe(s.model, s.state, s.scene);
    StepSolution step;
    const Status status = s.solver.solve({s.model, s.scene, s.state, now, s.control}, step);
    EXPECT_EQ(status.outcome, Outcome::infeasible) << status.message;
    EXPECT_EQ(
        status.message.find("constraints contradict each other: head clamp, velocity 0; head plate "
                            "at body "),
        0u)
        << status.message;
  }
}

TEST(Step, ThrowsOnAVelocityThatIsNotFinite) {
  for (const bool clamp : {true, false}) {
    SCOPED_TRACE(clamp ? "clamped" : "free");
    for (const int k : {0, 6, 100}) {
      Stage s = knotted(104, 1);
      s.control.clamp_head = clamp;
      s.state.qdot[k] = nan_value;
      EXPECT_THROW(s.solve(), StepError) << "velocity " << k;
      s.control.thigmotaxis.clear();
      EXPECT_THROW(s.solve(), StepError) << "velocity " << k;
    }
    Stage s = knotted(104, 1);
    s.control.clamp_head = clamp;
    s.state.qdot[100] = 1e200;  // its square overflows in the bias
    EXPECT_THROW(s.solve(), StepError);
  }
  // Nothing to solve for: no clamp, no limits.
  Stage free = two_hinges(std::numeric_limits<double>::infinity());
  free.control.clamp_head = false;
  free.control.tip.value << nan_value, 0, 0;
  EXPECT_THROW(free.solve(), StepError);
}

TEST(Step, ThrowsOnAPositionThatIsNotFinite) {
  for (const int k : {0, 3, 9, 100}) {
    Stage s = knotted(105, 1);
    s.state.q[k] = nan_value;
    EXPECT_THROW(s.solve(), StepError) << "coordinate " << k;
  }
}

}  // namespace hagfish::step_failure_test
