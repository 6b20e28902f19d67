// Limits on the total angle of universal joints: what a model, a start, a run and its watch make of
// them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/chain/start.hpp"
#include "core/step/look_ahead.hpp"
#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"
#include "tests/support/scene_run.hpp"

namespace hagfish::cone_test {

constexpr double degree = std::numbers::pi / 180;

TEST(Cones, TakeThePlaceOfTheHingesLimits) {
  const Model boxes = table1_hagfish();
  const Model model = cone_hagfish();
  ASSERT_EQ(model.cones.size(), 50U);
  EXPECT_TRUE(boxes.cones.empty());
  EXPECT_TRUE((bending_limits(boxes).array() == INFINITY).all());
  EXPECT_EQ(hinge_ranges(model), hinge_ranges(boxes));  // with the other hinge straight
  for (const BendingCone& cone : model.cones) {
    const std::size_t k = cone.dof - root_dofs;
    EXPECT_EQ(cone.limit, boxes.hinges[k].upper);
    EXPECT_NE(model.hinges[k].axis, Axis::x);
    EXPECT_NE(model.hinges[k + 1].axis, Axis::x);
    for (const std::size_t hinge : {k, k + 1}) {
      EXPECT_EQ(model.hinges[hinge].upper, INFINITY);
      EXPECT_EQ(model.hinges[hinge].lower, -INFINITY);
      EXPECT_EQ(model.hinges[hinge].stiffness, boxes.hinges[hinge].stiffness);
    }
    EXPECT_EQ(bending_limits(model)[model.hinges[k].body], cone.limit);
  }
  for (std::size_t k = 0; k < model.hinges.size(); ++k) {
    if (model.hinges[k].axis == Axis::x) {
      EXPECT_EQ(model.hinges[k].upper, boxes.hinges[k].upper);
    }
  }
}

TEST(Cones, AreScaledAndBounded) {
  Scene scene = table1_scene(20);
  scene.model.bending_limit = BendingLimit::cone;
  const Model even = make_hagfish(table1_specimen(), scene);
  scene.model.limit_scale = 0.5;
  const Model half = make_hagfish(table1_specimen(), scene);
  EXPECT_EQ(even.cones[4].limit, scene.model.largest_limit);
  scene.model.largest_limit = 1;
  EXPECT_EQ(make_hagfish(table1_specimen(), scene).cones[4].limit, 1);
  EXPECT_LT(half.cones[0].limit, even.cones[0].limit);
}

TEST(Cones, StopAStart) {
  const Model model = cone_hagfish();
  StartSettings settings;
  settings.bend = {{0, 0, -3, 4}};  // 2.5 and 3.4 rad of each joint, past where the axes part
  const State state = start_state(model, settings);
  settings.bend = {{0, 0, -1, 0.3}};  // some joints may bend so far
  const State slight = start_state(model, settings);
  int free = 0;
  for (const BendingCone& cone : model.cones) {
    // About Y, then about Z.
    const bool z_first = model.hinges[cone.dof - root_dofs].axis == Axis::z;
    const auto bend = [&](const State& of) -> Eigen::Vector2d {
      const Eigen::Vector2d first_and_next = of.q.segment<2>(cone.dof + 1);
      return z_first ? first_and_next.reverse() : first_and_next;
    };
    const Eigen::Vector2d angles = bend(state);
    EXPECT_NEAR(total_bend(angles[0], angles[1]).angle, cone.limit, 1e-15);
    const Eigen::Vector2d others = bend(slight);
    EXPECT_LE(total_bend(others[0], others[1]).angle, cone.limit + 1e-15);
    EXPECT_LT(others[0], 0);
    EXPECT_GT(others[1], 0);
    free += std::abs(others[0] + 0.848) < 1e-12 ? 1 : 0;
    EXPECT_LT(angles[0], 0);
    EXPECT_GT(angles[1], 0);
  }
  EXPECT_GT(free, 5);
  EXPECT_LT(free, 50);
  EXPECT_LE(observe(model, state, table1_scene()).limit_violation, 1e-15);  // rounding
}

TEST(Cones, AreWhatObserveAndTheWatchMeasure) {
  Scene scene = table1_scene();
  const Model model = cone_hagfish();
  State state = rest_state(model);
  const BendingCone& cone = model.cones[20];
  // Within the box, out of the cone.
  state.q.segment<2>(cone.dof + 1).setConstant(0.95 * cone.limit);
  const double over =
      std::acos(std::pow(std::cos(0.95 * cone.limit), 2)) - cone.limit;  // far from straight
  Observation now = observe(model, state, scene);
  EXPECT_NEAR(now.limit_violation, over, 1e-14);
  EXPECT_EQ(observe(table1_hagfish(), state, scene).limit_violation, 0);

  Watch watch;
  std::vector<std::string> warnings;
  scene.guard.penetration = INFINITY;
  scene.guard.limit_violation = 0.5 * over;
  scene.guard.action = GuardAction::warn;
  EXPECT_TRUE(guard_state(model, {state, now}, 0, scene, watch, warnings).ok());
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("j41_bend is ", 0), 0U) << warnings[0];
}

/// A body whose tail is pulled around in a circle, so that joints go around along their cones.
struct Swung : SceneRun {
  explicit Swung(double h, int corrections = 8)
      : SceneRun(table1_specimen(), swinging(h, corrections)) {}
  static Scene swinging(double h, int corrections) {
    Scene scene = table1_scene(30);
    scene.time.step = h;
    scene.wall.present = false;
    scene.contact.least_arc = INFINITY;
    scene.model.bending_limit = BendingLimit::cone;
    scene.model.limit_scale = 0.1;  // 7 to 25 degrees a joint
    scene.constraints.corrections = corrections;
    scene.script.kind = ScriptSettings::Kind::force;
    for (int k = 0; k <= 40; ++k) {
      const double turn = 0.25 * std::numbers::pi * k;
      scene.script.waypoints.push_back(
          {0.1 * k, {-500, 3000 * std::cos(turn), 3000 * std::sin(turn)}, {0, 0, 0}});
    }
    return scene;
  }
  /// One step, whose rows differ by their ids; counts cones that push and rows of one cone.
  void step() {
    SceneRun::step();
    worst = std::max(worst, sim.now.observation.limit_violation);
    std::set<RowId> ids;
    for (const Row& row : record.solution.rows) {
      EXPECT_TRUE(ids.insert(row.id).second) << row_name(model, row);
    }
    for (const BendingCone& cone : model.cones) {
      int rows = 0;
      for (const Row& row : record.solution.rows) {
        rows += row.id.of == RowId::Of::cone && row.id.first == cone.dof ? 1 : 0;
      }
      most_rows = std::max(most_rows, rows);
      pushing += record.solution.force[RowKind::limit].segment<2>(cone.dof).isZero(0) ? 0 : 1;
    }
  }
  void run(double until) {
    while (time() < until - 0.5 * scene.time.step) step();
  }
  double worst = 0;
  int pushing = 0, most_rows = 0;
};

class ConesAtStep : public testing::TestWithParam<double> {};

TEST_P(ConesAtStep, HoldAsJointsGoAroundThem) {
  Swung swung(GetParam());
  swung.run(2);
  Swung linear(GetParam(), 0);
  linear.run(2);
  // What may be let pass, and half of what the step before let pass.
  EXPECT_LE(swung.worst, 2.001 * bend_tolerance);
  EXPECT_LE(swung.worst, 0.001 * degree);
  EXPECT_GT(linear.worst, 0.001 * degree);
  EXPECT_GT(swung.pushing * GetParam(), 2);  // cones times s
  EXPECT_GT(swung.most_rows, GetParam() < 0.005 ? 1 : 2);
}

INSTANTIATE_TEST_SUITE_P(Steps, ConesAtStep, testing::Values(0.001, 0.002, 0.005));

TEST(Cones, StepsMeetTheDenseEquation4ByEitherSolver) {
  // Rows that came in where the path left a cone included.
  Swung swung(0.005);
  swung.run(0.5);
  int cut = 0;
  for (int k = 0; k < 20; ++k) {
    Swung again = swung;
    again.sim.solver = StepSolver("ipopt");
    again.sim.solver.warm = swung.sim.solver.warm;
    swung.step();
    again.step();
    cut += swung.most_rows > 1 ? 1 : 0;
    const StepSolution& step = swung.record.solution;
    EXPECT_LT(relative_error(again.record.solution.qdot, step.qdot), 1e-7) << k;
    EXPECT_LE(step.kkt.worst(), swung.scene.expect.kkt);
    EXPECT_LE(step.stationarity, 1e-9);
    const Kinematics& kin = swung.record.after.observation.kin;
    const Eigen::MatrixXd c = dense_rows(swung.model, kin, step.rows);
    const Eigen::VectorXd g =
        generalised_force(swung.model, kin, step.system.wrench) + step.system.joint;
    const Eigen::VectorXd impulse = c.transpose() * step.lambda;
    const Eigen::VectorXd left = dense(swung.model, kin, step.system.op) * step.qdot - g - impulse;
    EXPECT_LT(left.lpNorm<Eigen::Infinity>(), 1e-9 * impulse.lpNorm<Eigen::Infinity>());
    const Eigen::VectorXd velocity = c * step.qdot;
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      const double excess = velocity[j] - step.rows[i].rhs;
      EXPECT_GE(excess, -2e-8) << row_name(swung.model, step.rows[i]);  // rad/s
      EXPECT_GE(step.lambda[j], step.rows[i].lower);
      EXPECT_LE(std::abs(step.lambda[j] * excess), 1e-7 * step.lambda.lpNorm<1>());
    }
  }
  EXPECT_GT(cut, 0);
}

TEST(Cones, PassThroughTheMiddleWithinAStep) {
  // From a slight bend to one side far over to the other: the row of the step's start, which looks
  // to the near side, sees nothing of it.
  Scene scene = table1_scene(2);
  scene.model.bending_limit = BendingLimit::cone;
  scene.model.limit_scale = 0.001;
  scene.wall.present = false;
  scene.contact.least_arc = INFINITY;
  scene.time.step = 0.005;
  scene.guard.energy_action = EnergyAction::warn;
  SceneRun run(table1_specimen(), scene);
  const double limit = run.model.cones[0].limit;
  for (const double offset : {0.0, -0.1 * limit}) {
    State state = rest_state(run.model);
    state.q[7] = offset;
    state.qdot.tail<2>() << 40 * limit / scene.time.step, 20 * limit / scene.time.step;
    run.sim = start_from(run.model, scene, "active-set", state, {}, 0);
    run.step();
    const Eigen::VectorXd& q = run.sim.now.state.q;
    EXPECT_NEAR(total_bend(q[7], q[8]).angle, limit, bend_tolerance);
    EXPECT_GT(q[7], 0);
    EXPECT_GT(q[8], 0);
  }
}

}  // namespace hagfish::cone_test
