// The reflex: what a joint copies, what that makes of the shape of a body that nothing else moves,
// and what its senses show.
#include "core/control/reflex.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/control/laws.hpp"
#include "tests/support/plain_scene.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/scene_run.hpp"

namespace hagfish::reflex_test {

double arc_of(const Model& model, int k) {
  return model.length() * model.hinges[k].body / model.body_count();
}

double span_of(const Model& model, int k) { return hinge_span(model, model.hinges[k].body); }

Eigen::Index hinge_count(const Model& model) {
  return static_cast<Eigen::Index>(model.hinges.size());
}

/// An animal in empty space that weighs next to nothing, so that its shape is a matter of its
/// muscles and its own damping alone; bent about Y by `curvature` (of arc in cm, rad/cm).
struct Weightless : SceneRun {
  template <class Curvature>
  Weightless(double shift, double h, TimeRule rule, Curvature curvature)
      : SceneRun(light(), reflexive(shift, h, rule, curvature)) {}
  static Specimen light() {
    Specimen animal = table1_specimen();
    animal.mass = 0.01;
    return animal;
  }
  template <class Curvature>
  static Scene reflexive(double shift, double h, TimeRule rule, Curvature curvature) {
    Scene scene = table1_scene();
    scene.clamp_head = false;
    scene.wall.present = false;
    scene.drag = {};
    scene.model.bending_stiffness = B;
    scene.model.bending_damping = damping;
    scene.model.twist_stiffness = B;
    scene.model.twist_damping = damping;
    scene.active = {Ba, 0.01, 1, 1e9};
    scene.start.phase = Phase::slide;
    scene.controller.law = "reflex";
    scene.controller.reflex.shift = shift;
    scene.guard.action = GuardAction::warn;  // there is no knot to be lost
    scene.time.step = h;
    scene.time.rule = rule;
    const double v = speed(shift), length = light().length;
    constexpr int stations = 200;
    for (int i = 0; i <= stations; ++i) {
      const double share = static_cast<double>(i) / stations, s = share * length, d = 1e-3;
      scene.start.bend.emplace_back(share, 0, curvature(s), 0);
      // It travels from the start.
      const double slope = (curvature(s + d) - curvature(s - d)) / (2 * d);
      scene.start.bend_rate.emplace_back(share, 0, v * slope, 0);
    }
    return scene;
  }
  void run(double until) {
    while (time() < until - 0.5 * scene.time.step) step();
  }
  static double speed(double shift) { return shift * (Ba + B) / damping; }

  static constexpr double Ba = 5e5, B = 2e5, damping = 3e3;  // dyn cm^2 (s)
};

TEST(CopiedAngle, IsTheCurvatureBehindAndNothingPastTheEnds) {
  const auto curvature = [](double s) { return 0.3 - 0.01 * s; };
  for (const int bodies : {60, 100, 101}) {
    const Model model = table1_hagfish(bodies);
    Eigen::VectorXd angles(hinge_count(model));
    for (int k = 0; k < angles.size(); ++k) {
      angles[k] = span_of(model, k) * curvature(arc_of(model, k));
    }
    for (const double shift : {0.01, 0.5, 2.3, -0.01, -0.5, -2.3, 50.0, -50.0}) {
      for (int k = 0; k < angles.size(); ++k) {
        const double arc = arc_of(model, k) + shift;
        const double spacing = 2 * model.length() / bodies;
        const double copied = copied_angle(model, angles, k, shift) / span_of(model, k);
        if (arc > 2 * spacing && arc < model.length() - 2 * spacing) {
          EXPECT_NEAR(copied, curvature(arc), 1e-14) << bodies << ", " << k << ", " << shift;
        } else if (arc < -spacing || arc > model.length() + spacing) {
          EXPECT_EQ(copied, 0);
        }
      }
    }
  }
}

/// A body bent as a clock's spring, ever more towards the tail, bends on everywhere at one rate:
/// κ(s, t) = κ(s + v t, 0) with v = Δ (B_a + B) / C. The tail's end, where nothing is left to copy,
/// is far away.
TEST(Reflex, AShapeTravelsAtItsSpeedWhateverTheStep) {
  constexpr double slope = 0.002, shift = 0.02, time = 0.3;  // rad/cm^2; cm; s
  for (const TimeRule rule : {TimeRule::euler, TimeRule::midpoint}) {
    for (const double h : {0.005, 0.001}) {
      Weightless s(shift, h, rule, [](double arc) { return 0.02 + slope * arc; });
      s.run(time);
      const double expected = slope * Weightless::speed(shift) * time;
      for (int k = 0; k < hinge_count(s.model); ++k) {
        const double arc = arc_of(s.model, k);
        if (s.model.hinges[k].axis != Axis::y || arc < 5 || arc > 30) continue;
        const double gained = s.sim.now.state.q[7 + k] / span_of(s.model, k) - (0.02 + slope * arc);
        EXPECT_NEAR(gained / expected, 1, 0.02) << arc << " cm, h = " << h;
      }
    }
  }
}

class ReflexSenses : public testing::Test {
 protected:
  /// What is asked for in the step to come.
  const Control& ask() { return s.step().control; }
  Weightless s{0.5, 0.002, TimeRule::euler, [](double arc) { return 0.02 + 0.002 * arc; }};
};

TEST_F(ReflexSenses, CopyOnlyTheTurnsThatTheyAreTo) {
  s.scene.controller.reflex.bend_y = false;
  const Eigen::VectorXd q = s.sim.now.state.q, v = s.sim.now.state.qdot;
  const Control& control = ask();
  EXPECT_TRUE(control.thigmotaxis.empty());
  for (int k = root_dofs; k < s.model.nv(); ++k) {
    EXPECT_EQ(control.rest_shape[k], q[k + 1] + 0.002 * v[k]);  // the others are straight
  }
}

TEST_F(ReflexSenses, MoveNothingWhereTheBodyTouchesNothing) {
  s.scene.controller.reflex.gate = ReflexGate::touch;
  s.scene.controller.reflex.reach = 3;
  const Eigen::VectorXd q = s.sim.now.state.q, v = s.sim.now.state.qdot;
  const Control& control = ask();
  for (int k = root_dofs; k < s.model.nv(); ++k) {
    EXPECT_EQ(control.rest_shape[k], q[k + 1] + 0.002 * v[k]);
  }
}

TEST_F(ReflexSenses, ShowWhatWasWhereTheyAreLate) {
  s.scene.controller.reflex.delay = 0.01;  // five steps
  std::vector<Eigen::VectorXd> angles;
  const Eigen::Index count = hinge_count(s.model);
  for (int step = 0; step < 12; ++step) {
    angles.emplace_back(s.sim.now.state.q.tail(count));
    const Eigen::VectorXd own = angles.back() + 0.002 * s.sim.now.state.qdot.tail(count);
    const Control& control = ask();
    const Eigen::VectorXd& seen = angles[static_cast<std::size_t>(std::max(0, step - 5))];
    for (int k = 0; k < count; ++k) {
      EXPECT_NEAR(control.rest_shape[root_dofs + k],
                  own[k] + copied_angle(s.model, seen, k, 0.5) - seen[k], 1e-15);
    }
  }
}

TEST_F(ReflexSenses, AreWrongByTheirSeed) {
  s.scene.controller.reflex.noise = 0.1;
  const auto rest = [this](unsigned seed) {
    s.scene.controller.reflex.seed = seed;
    Simulation copy = s.sim;
    take_step(s.model, s.scene, copy, s.record);
    return s.record.control.rest_shape;
  };
  EXPECT_EQ(rest(1), rest(1));
  EXPECT_NE(rest(1), rest(2));
  const Eigen::VectorXd noisy = rest(3);
  s.scene.controller.reflex.noise = 0;
  // Each angle is off by a tenth of itself, in the mean of the squares.
  const Eigen::VectorXd off = noisy - rest(3);
  EXPECT_GT(off.norm(), 0.01 * s.sim.now.state.q.norm());
  EXPECT_LT(off.norm(), 0.3 * s.sim.now.state.q.norm());
}

TEST(ReflexPhases, TurnItRoundOnTheWayBackAndLetItPull) {
  const ReflexSettings reflex{.shift = 0.1, .pull_shift = 0.3};
  EXPECT_EQ(reflex_shift(reflex, Phase::slide), 0.1);
  EXPECT_EQ(reflex_shift(reflex, Phase::reverse), -0.1);
  EXPECT_EQ(reflex_shift(reflex, Phase::pull), 0.3);
  EXPECT_EQ(reflex_shift({.shift = 0.1}, Phase::pull), 0.1);
  for (const Phase phase : {Phase::tighten, Phase::slide, Phase::pull, Phase::reverse}) {
    EXPECT_TRUE(reflex_acts(phase));
  }
  for (const Phase phase : {Phase::form, Phase::release, Phase::free}) {
    EXPECT_FALSE(reflex_acts(phase));
  }
}

TEST(ReflexScene, IsRefusedInALine) {
  const auto complaint = [](std::vector<std::string> set) {
    set.insert(set.begin(), {"controller.law=reflex", "controller.reflex.shift=0.1",
                             "active.stiffness=1e5", "active.relax_time=1", "active.capacity=1e5"});
    return scene_complaint("", set);
  };
  const std::string key = "controller.reflex.";
  EXPECT_EQ(complaint({}), "no error");
  const std::pair<std::vector<std::string>, std::string> wrong[] = {
      {{"controller.reflex.shift=0"}, key + "shift"},
      {{"controller.reflex.shift=-40"}, key + "shift"},
      {{"controller.reflex.pull_shift=40"}, key + "pull_shift"},
      {{"controller.reflex.delay=0.001"}, key + "delay"},
      {{"controller.reflex.delay=1e9"}, key + "delay"},
      {{"controller.reflex.gate=touch"}, key + "reach"},
      {{"controller.reflex.gate=touch", "controller.reflex.reach=1", "contact.least_arc=40"},
       key + "gate"},
      {{"controller.reflex.bend_y=false", "controller.reflex.bend_z=false",
        "controller.reflex.twist=false"},
       key + "bend_y"},
      {{"active.stiffness=0"}, "active.stiffness"},
      {{"active.capacity=0"}, "active.capacity"},
      {{"controller.law=reflex_muscles"}, "muscle.present"}};
  for (const auto& [set, named] : wrong) {
    const std::string said = complaint(set);
    EXPECT_NE(said.find(named), std::string::npos) << said;
  }
}

}  // namespace hagfish::reflex_test
