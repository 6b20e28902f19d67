// Bodies against obstacles, in whole runs: forces of closed form, and no overlap, at short steps
// and long ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/chain/start.hpp"
#include "core/control/control_law.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/scene_run.hpp"

namespace hagfish::obstacles_test {

constexpr double allowed_overlap = 0.001;  // cm, of any step

Obstacle strand(const std::string& name, const std::vector<Eigen::Vector3d>& points, double radius,
                bool closed = false) {
  return {name, Strand{points, radius, closed}};
}

/// A run of a model with obstacles, pulled by a force on its last body.
struct Obstructed : SceneRun {
  Obstructed(const Model& of, Scene in, const State& state, const Eigen::Vector3d& pull)
      : SceneRun(ResolvedScene{std::move(in), {}, of}) {
    scene.controller.law = own_law;
    ControllerState controller;
    controller.phase = Phase::free;
    sim = start_from(model, scene, "active-set", state, controller, 0);
    const bool clamped = scene.clamp_head;
    sim.law = [pull, clamped](const Situation&, Eigen::VectorXd&, Control& control) {
      control.clamp_head = clamped;
      control.tip = {pull, 0};
    };
  }
  /// Steps on for `duration` s. A step's force is an impulse over h: means are taken of all of
  /// them.
  void run(double duration) {
    const auto steps = std::lround(duration / scene.time.step);
    on_body = on_head = Eigen::Vector3d::Zero();
    for (long k = 0; k < steps; ++k) {
      step();
      overlap = std::max(overlap, sim.now.observation.penetration);
      on_body += force_of(0) / static_cast<double>(steps);
      on_head += record.solution.force[RowKind::head].head<3>() / static_cast<double>(steps);
    }
  }
  const Eigen::Matrix3Xd& centres() const { return sim.now.observation.kin.centre; }
  double speed() const {
    return sim.now.observation.kin.centre_velocity.colwise().norm().maxCoeff();
  }
  /// Force of an obstacle on the body in the last step, dyn.
  Eigen::Vector3d force_of(int obstacle) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const StepSolution& step = record.solution;
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      if (step.rows[i].obstacle == obstacle) {
        sum += step.lambda[static_cast<Eigen::Index>(i)] / scene.time.step *
               step.rows[i].points().direction;
      }
    }
    return sum;
  }

  double overlap = 0;  ///< deepest so far, cm
  Eigen::Vector3d on_body,
      on_head;  ///< means of the last run: of the first obstacle, the clamp; dyn
};

class AtSteps : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Obstacles, AtSteps, testing::Values(0.001, 0.005, 0.02));

// A stiff rod of 11 cm that falls across two poles lies still, and each carries what the lever
// says.
TEST_P(AtSteps, ARodOnTwoPolesIsCarriedByTheLever) {
  constexpr double mass = 2, gravity = 981;  // g of each of 11 bodies, cm/s^2
  Model model;
  for (int b = 0; b < 11; ++b) {
    append_body(model, {mass, 1, 0.5, cylinder_inertia(mass, 1, 0.5), 0, 0}, {});
  }
  model.gravity = {0, 0, -gravity};
  model.drag = {.normal = 50, .tangential = 50};
  const auto pole = [](double x) { return strand("pole", {{x, -4, -1.2}, {x, 4, -1.2}}, 0.5); };
  model.obstacles = {pole(2), pole(8)};
  Scene scene;
  scene.clamp_head = false;
  scene.time.step = GetParam();
  scene.contact.least_arc = INFINITY;
  Obstructed rod(model, scene, rest_state(model), Eigen::Vector3d::Zero());
  rod.run(1);
  EXPECT_LT(rod.overlap, allowed_overlap);
  EXPECT_LT(rod.speed(), 1e-6);
  const double weight = 11 * mass * gravity;  // at x = 5.5
  EXPECT_NEAR(rod.force_of(0).z(), weight * 2.5 / 6, 1e-6 * weight);
  EXPECT_NEAR(rod.force_of(1).z(), weight * 3.5 / 6, 1e-6 * weight);
}

/// The animal in half a circle about a pole, its head clamped, the tail pulled back along the head.
TEST_P(AtSteps, ALoopRoundAPoleHoldsWhatPullsAtBothEnds) {
  Scene scene = table1_scene();
  scene.wall.present = false;
  scene.time.step = GetParam();
  scene.drag = {.normal = 20, .tangential = 20};
  Model model = make_hagfish(table1_specimen(), scene);
  // 12 cm straight, then half a turn of 4.5 cm radius, then straight.
  constexpr double straight = 12, radius = 4.5, pull = 2000;
  StartSettings start;
  const double a = straight / 42.4, b = a + std::numbers::pi * radius / 42.4;
  start.bend = {
      {a, 0, 0, 0}, {a + 1e-3, 0, 0, 1 / radius}, {b, 0, 0, 1 / radius}, {b + 1e-3, 0, 0, 0}};
  model.obstacles = {strand("pole", {{straight - 1, radius, -8}, {straight - 1, radius, 8}}, 2)};
  Obstructed loop(model, scene, start_state(model, start), {-pull, 0, 0});
  loop.run(8);
  loop.run(1);
  EXPECT_LT(loop.overlap, allowed_overlap);
  EXPECT_LT(loop.speed(), 0.05);
  // The pole is still inside, and holds both strands; water takes what is left of motion.
  EXPECT_NEAR((loop.on_body + loop.on_head + Eigen::Vector3d(-pull, 0, 0)).norm(), 0, 0.03 * pull);
  EXPECT_GT(loop.on_body.x(), 1.5 * pull);
  EXPECT_LT(loop.centres().col(99).x(), straight - 1);
}

/// The animal, tail first, pulled aslant through a ring not much wider than it is.
TEST_P(AtSteps, TheBodyPassesARingWithoutOverlap) {
  Scene scene = table1_scene();
  scene.wall.present = false;
  scene.clamp_head = false;
  scene.time.step = GetParam();
  Model model = make_hagfish(table1_specimen(), scene);
  constexpr double at = 36, inner = 1.1, thickness = 0.3;
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 32; ++k) {
    const double turn = 2 * std::numbers::pi * k / 32;
    points.emplace_back(at, (inner + thickness) * std::cos(turn),
                        (inner + thickness) * std::sin(turn));
  }
  model.obstacles = {strand("ring", points, thickness, true)};
  Obstructed body(model, scene, rest_state(model), {1500, 500, 300});
  body.run(1.5);
  EXPECT_LT(body.overlap, allowed_overlap);
  // Some body has come through, by the hole: where the body crosses the ring's plane, it is inside.
  EXPECT_GT(body.centres()(0, 0), 10);
  int crossings = 0;
  for (int b = 0; b < 99; ++b) {
    const Eigen::Vector3d p = body.centres().col(b), q = body.centres().col(b + 1);
    if ((p.x() - at) * (q.x() - at) < 0) {
      ++crossings;
      const Eigen::Vector3d x = p + (q - p) * (at - p.x()) / (q.x() - p.x());
      EXPECT_LT(x.tail<2>().norm(), inner);
    }
  }
  EXPECT_EQ(crossings, 1);
}

/// How often the body between two arcs (cm) goes around the line through two points.
double winding(const Model& model, const Eigen::Matrix3Xd& centre, double from, double to,
               const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  const Eigen::Vector3d axis = (q - p).normalized();
  const Eigen::Vector3d across = axis.unitOrthogonal();
  const Eigen::Vector3d third = axis.cross(across);
  const double length = model.length() / model.body_count();
  double turn = 0, before = NAN;
  for (int b = static_cast<int>(from / length); (b + 0.5) * length < to; ++b) {
    const Eigen::Vector3d off = centre.col(b) - p;
    const double angle = std::atan2(off.dot(third), off.dot(across));
    if (!std::isnan(before)) turn += std::remainder(angle - before, 2 * std::numbers::pi);
    before = angle;
  }
  return turn / (2 * std::numbers::pi);
}

// The built-in scene: the loop of the knot has the pole in it, and keeps it.
TEST(KnotRoundAPole, SlidesUntilItHangsOnThePole) {
  SceneRun run("knot_round_a_pole");
  const StepRecord& record = run.record;
  double overlap = 0, tied = 0;
  while (!run.over()) {
    run.step();
    overlap = std::max(overlap, run.sim.now.observation.penetration);
    if (record.controller.phase == Phase::slide && tied == 0) {
      tied = knot_span(record.controller)->head_end;
    }
  }
  EXPECT_LE(overlap, allowed_overlap);
  EXPECT_EQ(knot_name(record.controller.knot.type), "3_1");
  const auto span = knot_span(record.controller);
  ASSERT_TRUE(span);
  EXPECT_GT(tied - span->head_end, 3);  // it slid,
  EXPECT_GT(span->head_end, 5);         // and hangs: without the pole it is at the head by now
  const Strand& pole = *run.model.obstacles.at(1).strand();
  EXPECT_GT(std::abs(winding(run.model, run.sim.now.observation.kin.centre, span->head_end,
                             span->tail_end, pole.points[0], pole.points[1])),
            0.6);
}

// A smooth pole pushes across itself alone: nothing holds a knot on it along its axis (capstan
// without friction), however the animal is wound round it.
TEST(LivingKnotRoundAPole, IsPushedAcrossThePoleAlone) {
  SceneRun run("reflex_pole");
  const Strand& pole = *run.model.obstacles.at(0).strand();
  const Eigen::Vector3d axis = (pole.points.back() - pole.points.front()).normalized();
  double least_turn = INFINITY, across = 0, along = 0;
  while (run.phase() != Phase::release) {
    const StepSolution& step = run.step().solution;
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      if (step.rows[i].obstacle != 0) continue;
      const double push = step.lambda[static_cast<Eigen::Index>(i)] / run.scene.time.step;
      along = std::max(along, std::abs(push * step.rows[i].points().direction.dot(axis)));
      across = std::max(across, push);
    }
    if (run.record.controller.phase == Phase::slide) {
      const auto span = knot_span(run.record.controller);
      ASSERT_TRUE(span);
      const double turn = winding(run.model, run.sim.now.observation.kin.centre, span->head_end,
                                  span->tail_end, pole.points.front(), pole.points.back());
      least_turn = std::min(least_turn, std::abs(turn));
    }
  }
  std::cout << "[ FIGURE   ] " << across << " dyn across, " << along << " along; " << least_turn
            << " turns at least\n";
  EXPECT_GT(across, 1000);
  EXPECT_LT(along, 5e-3 * across);  // how well closest points are known leaves 0.2 %
  EXPECT_GT(least_turn, 1);
}

}  // namespace hagfish::obstacles_test
