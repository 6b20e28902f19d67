// What a row of Eq. 6 asks for while its speed is below the commanded one.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::command_ramp_test {

// A knot in random motion, its rows' speeds by dense algebra. Commands far above the speeds ask for
// what the acceleration makes in a step, those far below for themselves.
TEST(CommandRamp, AsksForTheSpeedNowAndOneStepOfAcceleration) {
  constexpr double h = 0.004;
  constexpr double out_of_reach = 1000;  // cm/s; the strands move at some 10
  const Model model = table1_hagfish();
  Random random(151);
  State state = knotted_state(random, model, 2.45, 0.002);
  state.qdot = random_entries(random, model.nv());
  const Kinematics kin = kinematics(model, state);
  const Contact contact = find_contacts(spline(model, kin.centre), {}).contacts.front();
  ControllerSettings settings;
  settings.acceleration = 25;
  for (const BodyEnd towards : {BodyEnd::head, BodyEnd::tail}) {
    const std::vector<Row> rows = thigmotaxis_rows(
        model, {{contact, {out_of_reach, -out_of_reach}, towards}, {contact, {-3, 1e3}, towards}},
        settings, kin, h);
    ASSERT_EQ(rows.size(), 4U);
    const Eigen::VectorXd now = dense_rows(model, kin, rows) * state.qdot;
    EXPECT_GT(now.cwiseAbs().minCoeff(), 0.1);  // there is something to tell apart
    EXPECT_NEAR(rows[0].rhs, now[0] + 25 * h, 1e-12 * out_of_reach);
    EXPECT_EQ(rows[1].rhs, -out_of_reach);
    EXPECT_NEAR(rows[2].rhs, std::min(-3.0, now[2] + 25 * h), 1e-12 * out_of_reach);
    EXPECT_NEAR(rows[3].rhs, now[3] + 25 * h, 1e-12 * out_of_reach);
  }
}

/// Largest entry of f_thigmo, dyn cm, in the first 20 ms after the Table 1 run's knot, half
/// tightened, is told to slide.
double largest_at_start(const std::string& step, const std::string& acceleration) {
  const auto [scene, specimen] = stored_scene(
      {"time.step=" + step, "controller.acceleration=" + acceleration, "controller.cap=1e6"});
  const Model model = make_hagfish(specimen, scene);
  const std::vector<StoredState> states = stored_states();
  StoredState tight = *std::ranges::find(states, "tighten", &StoredState::name);
  tight.phase = Phase::slide;
  Simulation sim = resume(model, scene, tight);
  const double end = time_of(sim, scene) + 0.02;
  double largest = 0;
  while (time_of(sim, scene) < end) {
    const StepRecord record = take_step(model, scene, sim);
    largest =
        std::max(largest, record.solution.force[RowKind::thigmotaxis].lpNorm<Eigen::Infinity>());
  }
  return largest;
}

// An acceleration has a force; a jump of the speed has an impulse, whose force goes as 1 / h.
TEST(CommandRamp, ForceOfAStartDoesNotGrowAsTheStepShrinks) {
  const double coarse = largest_at_start("0.002", "60");
  const double fine = largest_at_start("0.0005", "60");
  EXPECT_LT(std::max(coarse, fine), 1.3 * std::min(coarse, fine));
  // Without the ramp it does, and the check above would see it.
  EXPECT_GT(largest_at_start("0.0005", "1e9"), 2.5 * largest_at_start("0.002", "1e9"));
}

}  // namespace hagfish::command_ramp_test
