// The rows of Eq. 6 in the log: each in its own column, whatever the order in which a step has
// them; means over steps are what the single steps say.
#include "core/log/means/thigmotaxis_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/log/means/log_means.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::thigmotaxis_rows_test {

/// A step of the stored slide, whose knot's first and last contact are commanded differently.
class ThigmotaxisRowsTest : public testing::Test, protected SceneRun {
 protected:
  ThigmotaxisRowsTest()
      : SceneRun(resumed(stored_state("slide"),
                         {"controller.slide_head.a=0.5", "controller.slide_head.b=1",
                          "controller.slide_tail.a=3", "controller.slide_tail.b=4",
                          "controller.contact_patch=0"})) {}
};

TEST_F(ThigmotaxisRowsTest, ColumnsAreThoseOfTheirContact) {
  step();
  const ThigmotaxisRows rows =
      thigmotaxis_rows_of(record.control, record.solution, scene.time.step);
  ASSERT_EQ(record.control.thigmotaxis.size(), 2u);
  const Eigen::Matrix3Xd& velocity = record.solution.centre_velocity;
  const int n = model.body_count();
  const auto at = [&](int segment, double t) {
    const SplineMix mix = spline_mix(segment, t, n);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < mix.count; ++k) {
      sum += mix.weight[k] * velocity.col(mix.first + k);
    }
    return sum;
  };
  const double commands[] = {0.5, 1, 3, 4};
  for (int place = 0; place < 2; ++place) {
    const Contact& c = place == 0 ? *record.controller.ends.first : *record.controller.ends.last;
    const Eigen::Vector3d apart = at(c.segment_a, c.t_a) - at(c.segment_b, c.t_b);
    // Eq. 6, left sides; rounding of sums of four.
    EXPECT_NEAR(rows.speed[2 * place], c.tangent_a.dot(apart), 1e-12);
    EXPECT_NEAR(rows.speed[2 * place + 1], -c.tangent_b.dot(apart), 1e-12);
    for (const int k : {2 * place, 2 * place + 1}) {
      EXPECT_EQ(rows.command[k], commands[k]);
      // A row with a force below its cap is met exactly (rounding of the solver).
      if (rows.lambda[k] > 0 && rows.lambda[k] < scene.controller.cap) {
        EXPECT_NEAR(rows.speed[k], commands[k], 1e-9);
      }
    }
  }
  EXPECT_TRUE(rows.any);
  EXPECT_DOUBLE_EQ(rows.cap, scene.controller.cap);
}

TEST_F(ThigmotaxisRowsTest, TheCapIsThatOfTheCommand) {
  step();
  for (ThigmotaxisCommand& command : record.control.thigmotaxis) {
    command.effort = 0.25;
    command.speed = {100, 100};  // more than there is force for
  }
  const ObservedState& now = record.after;
  StepSolution step;
  ASSERT_TRUE(
      sim.solver.solve({model, scene, now.state, now.observation, record.control}, step).ok());
  const ThigmotaxisRows rows = thigmotaxis_rows_of(record.control, step, scene.time.step);
  EXPECT_DOUBLE_EQ(rows.cap, 0.25 * scene.controller.cap);
  EXPECT_NEAR(*std::ranges::max_element(rows.lambda), rows.cap, 1e-9 * rows.cap);
  EXPECT_TRUE(std::isnan(thigmotaxis_rows_of({}, {}, scene.time.step).cap));
}

TEST_F(ThigmotaxisRowsTest, RowsAtOtherContactsLeaveThoseOfTheEndsInTheirColumns) {
  step();
  const ObservedState& now = record.after;
  Control& control = record.control;
  const std::vector<ThigmotaxisCommand> ends = control.thigmotaxis;
  control.thigmotaxis.clear();
  const auto is_of = [](const Contact& a, const Contact& b) {
    return a.segment_a == b.segment_a && a.segment_b == b.segment_b;
  };
  for (const Contact& c : now.observation.contact.contacts) {
    if (!is_of(c, ends[0].contact) && !is_of(c, ends[1].contact)) {
      control.thigmotaxis.push_back({c, {50, -7}});
    }
  }
  const auto others = static_cast<int>(control.thigmotaxis.size());
  ASSERT_GE(others, 2);
  control.thigmotaxis.insert(control.thigmotaxis.end(), ends.begin(), ends.end());
  StepSolution step;
  ASSERT_TRUE(sim.solver.solve({model, scene, now.state, now.observation, control}, step).ok());
  const ThigmotaxisRows rows = thigmotaxis_rows_of(control, step, scene.time.step);
  EXPECT_EQ(rows.command, (std::array<double, 4>{0.5, 1, 3, 4}));
  EXPECT_EQ(rows.others, 2 * others);
  EXPECT_FALSE(rows.met) << "50 cm/s are out of reach";
  // Each row by its contact, from the solution's velocity.
  double worst = 0, sum = 0;
  int seen = 0;
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    if (step.rows[i].kind != RowKind::thigmotaxis) continue;
    sum += step.lambda[static_cast<Eigen::Index>(i)];
    const ThigmotaxisRow row = thigmotaxis_row(control, step, i, scene.time.step);
    if (row.end != KnotEnd::neither) continue;
    ++seen;
    EXPECT_EQ(row.command, row.along_a ? 50 : -7);
    const auto command = std::ranges::find_if(control.thigmotaxis, [&](const auto& c) {
      return c.contact.segment_a + c.contact.t_a == row.spline_a &&
             c.contact.segment_b + c.contact.t_b == row.spline_b;
    });
    ASSERT_NE(command, control.thigmotaxis.end());
    const Contact& c = command->contact;
    const Row along = eq6_row(model, now.observation.kin, now.observation.segments, c, row.along_a,
                              BodyEnd::head, scene.controller.eq6_at);
    const double speed = row_velocity(along, step.bodies(), step.qdot);
    EXPECT_NEAR(row.speed, speed, 1e-12 * (1 + std::abs(speed)));
    EXPECT_NEAR(row.slack, std::max(0.0, row.command - speed), 1e-11);
    worst = std::max(worst, row.slack);
  }
  EXPECT_EQ(seen, rows.others);
  EXPECT_NEAR(rows.sum * scene.time.step, sum, 1e-12 * sum);
  EXPECT_GT(sum, 1.01 * scene.time.step *
                     (rows.lambda[0] + rows.lambda[1] + rows.lambda[2] + rows.lambda[3]))
      << "others bear, too";
  EXPECT_DOUBLE_EQ(rows.others_slack, worst);
}

TEST_F(ThigmotaxisRowsTest, MeansAreThoseOfTheSteps) {
  RunningMeans means(model.nv());
  EXPECT_TRUE(means.close().force[RowKind::contact].array().isNaN().all()) << "no step, no mean";
  constexpr int steps = 7;
  Eigen::VectorXd contact = Eigen::VectorXd::Zero(model.nv());
  Eigen::VectorXd net = contact;
  double sum = 0;
  std::array<double, 4> lambda{}, speed{};
  for (int i = 0; i < steps; ++i) {
    step();
    const ThigmotaxisRows rows =
        thigmotaxis_rows_of(record.control, record.solution, scene.time.step);
    means.take(record, rows);
    sum += rows.sum / steps;
    contact += record.solution.force[RowKind::contact] / steps;
    net += record.solution.force.total() / steps;
    for (int k = 0; k < 4; ++k) {
      lambda[k] += rows.lambda[k] / steps;
      speed[k] += rows.speed[k] / steps;
    }
  }
  const FrameMeans& mean = means.close();
  EXPECT_NEAR(mean.sum_of_rows, sum, 1e-9 * (1 + sum));
  const double rounding = 1e-9 * net.lpNorm<Eigen::Infinity>();
  EXPECT_LE((mean.force[RowKind::contact] - contact).lpNorm<Eigen::Infinity>(), rounding);
  EXPECT_LE((mean.net_force - net).lpNorm<Eigen::Infinity>(), rounding);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(mean.lambda[k], lambda[k], 1e-9 * (1 + lambda[k]));
    EXPECT_NEAR(mean.speed[k], speed[k], 1e-12);
  }
  EXPECT_TRUE(std::isnan(means.close().lambda[0])) << "starts over";
}

}  // namespace hagfish::thigmotaxis_rows_test
