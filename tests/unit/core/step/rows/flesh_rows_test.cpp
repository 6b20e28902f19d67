// Rows of flesh in a step: its velocity is that of the paper's dense step with springs and dampers
// at the same points, by both back ends, and hard contact has no rows beside them.
#include "core/step/rows/flesh_rows.hpp"

#include <gtest/gtest.h>

#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/step_stage.hpp"

namespace hagfish::flesh_rows_test {

Stage soft(unsigned seed) {
  Stage s = knotted(seed, 1);
  s.scene.flesh = {1e5, 0.015, 0.212};
  s.control.thigmotaxis.clear();
  return s;
}

TEST(FleshRows, AreSpringsAndDampersInTheStep) {
  for (const std::string& back_end : box_qp_solver_names()) {
    Stage s = soft(5);
    s.solver = StepSolver(back_end);
    const StepSolution step = s.solve();
    const Observation now = observe(s.model, s.state, s.scene);
    // H v = g + h Σ C' f with f by the law, of the points that push; all else is hard and in C.
    std::vector<Row> hard;
    PrimalQp paper = paper_problem(s.input(now), start_of(s.input(now)), {});
    int pushing = 0;
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      const Row& row = step.rows[i];
      const double lambda = step.lambda[static_cast<Eigen::Index>(i)];
      if (row.id.of != RowId::Of::flesh) {
        if (lambda != 0) hard.push_back(row);
        continue;
      }
      const double speed = row_velocity(row, step.bodies(), step.qdot);
      const auto point = std::ranges::find_if(now.flesh.points, [&](const FleshPoint& p) {
        const Contact& c = p.contact;
        const bool swapped = p.own != c.segment_a;
        return row.id.first == p.own && row.id.number == p.number &&
               row.id.second == (swapped ? c.segment_a : c.segment_b);
      });
      ASSERT_NE(point, now.flesh.points.end());
      const double h = s.scene.time.step, gap = point->contact.gap;
      const double lag = 0.5 * h + (gap < 0 ? 0.015 : 0);
      const double force = std::max(0.0, -1e5 * point->weight * (gap + lag * speed));
      EXPECT_NEAR(lambda / h, force, 1e-6 * (1 + force));
      pushing += lambda > 0 ? 1 : 0;
      const Eigen::MatrixXd c = dense_rows(s.model, now.kin, {row});
      paper.g += lambda * c.row(0).transpose();
    }
    EXPECT_GT(pushing, 5);
    // What is left is the rows of joints: H v - g - h Σ C' f is their impulse alone.
    const Eigen::VectorXd left = paper.H * step.qdot - paper.g;
    const Eigen::VectorXd joints =
        s.scene.time.step * (step.force[RowKind::head] + step.force[RowKind::limit]);
    EXPECT_LT((left - joints).lpNorm<Eigen::Infinity>(), 1e-8 * paper.g.lpNorm<Eigen::Infinity>());
    EXPECT_LT(step.worst_residual(), 1e-8);
  }
}

TEST(FleshRows, GiveThePapersDenseStep) {
  for (const unsigned seed : {6U, 7U}) {
    Stage s = soft(seed);
    const StepSolution step = s.solve();
    EXPECT_LT(relative_error(step.qdot, paper_velocity(s)), 1e-6);
  }
}

// Where the body is thickest at the border of two segments, each point of a ring has its one foot
// there: the gap falls up to the border and rises behind it.
TEST(Flesh, HasOneFootOnABorder) {
  Scene scene = table1_scene();
  scene.wall.present = false;
  scene.flesh = {1e5, 0.015, 0.212};
  Model model = make_hagfish(table1_specimen(), scene);
  model.bodies[30].radius += 0.1;
  const State rest = rest_state(model);
  const double x = kinematics(model, rest).centre(0, 30);  // where segments 29 and 30 meet
  model.obstacles = {{"ring", Strand{{{x, 0, 0.5}, {x, 1, 1}, {x, 2, 0}, {x, 1, -1}}, 0.3, true}}};
  const Observation seen = observe(model, rest, scene);
  std::vector<std::pair<int, int>> points;
  for (const FleshPoint& point : seen.flesh.points) {
    EXPECT_NEAR(point.contact.segment_a + point.contact.t_a, 30, 0.01);
    points.emplace_back(point.own, point.number);
  }
  EXPECT_GT(points.size(), 4U);
  std::ranges::sort(points);
  EXPECT_EQ(std::ranges::adjacent_find(points), points.end());
}

}  // namespace hagfish::flesh_rows_test
