// The midpoint rule: its equations on dense matrices, impacts that do not bounce, and the whip that
// Euler's rule cannot hold.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/step_stage.hpp"

namespace hagfish::midpoint_test {

/// A stage that steps by the midpoint rule.
struct MidpointStage {
  explicit MidpointStage(Stage of) : stage(std::move(of)) {
    stage.scene.time.rule = TimeRule::midpoint;
  }
  /// Takes a step and calls `see(input, place, solution)` before the state moves on.
  template <class See>
  void step(See see) {
    const Observation now = observe(stage.model, stage.state, stage.scene);
    const StepInput in{stage.model, stage.scene, stage.state, now, stage.control};
    ASSERT_TRUE(stage.solver.solve(in, solution).ok());
    see(in, stage.solver.place(in), solution);
    stage.state.q = advance(stage.state.q, solution.qdot, stage.scene.time.step);
    stage.state.qdot = solution.next;
  }
  Stage stage;
  StepSolution solution;
};

/// A run of a stress scene by the midpoint rule with steps of `h` (s), whose watch only warns.
SceneRun stress_run(const std::string& name, double h, std::vector<std::string> set = {}) {
  set.insert(set.end(),
             {"time.rule=midpoint", "time.step=" + std::to_string(h), "guard.energy_action=warn"});
  return SceneRun(HAGFISH_STRESS_DIR "/" + name + ".toml", set);
}

// M (v' - v) = h f + C'λ with f at the mean of both velocities, and what the step moves by: that
// mean and half of what impacts add, from the dense matrices of the paper's Eq. 1.
TEST(Midpoint, MeetsItsEquationsInAKnot) {
  MidpointStage run(knotted(1, 3));
  run.stage.scene.time.ring_damping = 100;  // so that it counts
  int pushing = 0;
  for (int k = 0; k < 4; ++k) {
    // Eq. 6 asks for a little more than there is: what a jump of a speed adds where a limit lets go
    // is not solved again.
    Stage& stage = run.stage;
    const Kinematics first = kinematics(stage.model, stage.state);
    const Eigen::VectorXd speed =
        dense_rows(stage.model, first,
                   thigmotaxis_rows(stage.model, stage.control.thigmotaxis, stage.scene.controller,
                                    first, stage.scene.time.step)) *
        stage.state.qdot;
    for (Eigen::Index e = 0; e < 2; ++e) {
      stage.control.thigmotaxis[e].speed = {speed[2 * e] + 0.2, speed[2 * e + 1] + 0.2};
    }
    run.step([&](const StepInput& in, const StepPlace& place, const StepSolution& step) {
      const Eigen::MatrixXd c = dense_rows(in.model, place.kin, step.rows);
      const auto m = static_cast<Eigen::Index>(step.rows.size());
      const Eigen::Map<const Eigen::VectorXd> lambda(step.lambda.data(), m);
      Eigen::VectorXd impact(m);
      for (Eigen::Index i = 0; i < m; ++i) impact[i] = step.rows[i].impact;
      // By H = M + (h/2) D + (h/2)² K, in which half a step's forces are implicit.
      const PrimalQp paper = paper_problem(in, place, step.rows);
      const Eigen::VectorXd mean = 0.5 * (in.state.qdot + step.next);
      const Eigen::VectorXd half = 0.5 * c.transpose() * lambda;
      const double scale =
          std::max((paper.H * mean).lpNorm<Eigen::Infinity>(), half.lpNorm<Eigen::Infinity>());
      // Dense matrices of condition 1e6 or so against recursions.
      EXPECT_LT((paper.H * mean - paper.g - half).lpNorm<Eigen::Infinity>(), 1e-10 * scale) << k;
      const Eigen::VectorXd moved = paper.H * (step.qdot - mean) - 0.5 * c.transpose() * impact;
      EXPECT_LT(moved.lpNorm<Eigen::Infinity>(), 1e-10 * scale) << k;
      // A row that pushes ends with the velocity that it asks for.
      for (Eigen::Index i = 0; i < m; ++i) {
        const Row& row = step.rows[i];
        const double size = 1e-9 * std::abs(lambda[i]);
        if (lambda[i] == 0 || lambda[i] - row.lower < size || row.upper - lambda[i] < size)
          continue;
        // Where a held limit is let go the impacts of other rows are not solved again: 2.6e-6 of
        // speeds of some 30 here; else to the shift of their diagonal, 1e-8.
        EXPECT_NEAR(c.row(i).dot(step.next), row.rhs, 1e-5) << k << " row " << i;
        ++pushing;
      }
    });
  }
  EXPECT_GT(pushing, 10);
}

// Rows that carry a load from the first step on leave no velocity: what moves nothing stays so.
TEST(Midpoint, ALoadThatBeginsLeavesNoVelocity) {
  MidpointStage run(two_hinges(0.5));
  run.stage.scene.drag = {};
  run.stage.model.drag = {};
  run.stage.state.q[7] = 0.5;
  run.stage.control.active.value = Eigen::VectorXd::Zero(run.stage.model.nv());
  run.stage.control.active.rate = Eigen::VectorXd::Zero(run.stage.model.nv());
  run.stage.control.active.value[6] = 1000;  // against its limit
  for (int k = 0; k < 5; ++k) {
    run.step([&](const StepInput&, const StepPlace&, const StepSolution& step) {
      EXPECT_NEAR(step.next[6], 0, 1e-9) << k;
      EXPECT_NEAR(step.qdot[6], 0, 1e-9) << k;
    });
  }
}

// A spring far too stiff for the step turns the velocity round; numerical damping lets that die:
// where it is all, K (q + h/2 x + c h² v') = 0 with q = 0 says v' = -v / (1 + 4 c h).
TEST(Midpoint, StiffSpringsRingDown) {
  MidpointStage run(two_hinges(10));
  run.stage.scene.drag = {};
  run.stage.model.drag = {};
  for (Hinge& hinge : run.stage.model.hinges) hinge.stiffness = 1e12;
  run.stage.scene.time.step = 0.01;
  run.stage.scene.time.ring_damping = 10;
  run.stage.state.qdot.tail<2>() << 1e-3, -2e-3;
  const Eigen::Vector2d before = run.stage.state.qdot.tail<2>();
  run.step([&](const StepInput&, const StepPlace&, const StepSolution& step) {
    // To M / (h² K), some 1e-8.
    EXPECT_LT((step.next.tail<2>() + before / 1.4).norm(), 1e-6 * before.norm());
  });
}

// A hinge that flies into its limit stays there: impulses act in full, and are not expected again.
TEST(Midpoint, AnImpactDoesNotBounce) {
  MidpointStage run(two_hinges(0.5));
  run.stage.scene.drag = {};
  run.stage.model.drag = {};
  run.stage.state.q[7] = 0.49;
  run.stage.state.qdot[6] = 20;
  for (int k = 0; k < 20; ++k) {
    run.step([](const StepInput&, const StepPlace&, const StepSolution&) {});
    EXPECT_LE(run.stage.state.q[7], 0.5 + 1e-12) << k;
  }
  // It came from 0.49: rebounding it would be far from there by now, at 20 rad/s.
  EXPECT_GT(run.stage.state.q[7], 0.45);
}

// Each body's bias works what the body's kinetic energy asks for: all that is left of an error in
// the energy of a free body without drag, which turns by more than 0.01 rad in a step, is what
// passes leave.
TEST(Midpoint, ConservesEnergy) {
  for (const double h : {0.004, 0.005}) {
    SceneRun run = stress_run("spinning", h,
                              {"drag.normal=0", "drag.tangential=0", "time.ring_damping=0",
                               "time.settled=1e-10", "time.passes=100"});
    const auto energy = [&] {
      return kinetic_energy(run.model, run.sim.now.observation.kin) +
             elastic_energy(run.model, run.sim.now.state.q);
    };
    const double before = energy();
    double furthest = 0;
    while (run.time() < 1) {
      run.step();
      furthest = std::max(furthest, std::abs(energy() / before - 1));
    }
    // Passes leave 1e-10 rad/s of some 10; bodies that turn by less leave up to 4e-8.
    EXPECT_LT(furthest, 1e-7) << h;
  }
}

// J moves along one velocity and multiplies another: with one for both, this whip doubles its
// energy within 10 s, and by Euler's rule it blows up after 2.2 s.
TEST(Midpoint, HoldsTheWhip) {
  SceneRun run = stress_run("whip", 0.002);
  const auto& ledger = run.sim.ledger;
  double furthest = 0;
  while (run.time() < 5) {
    run.step();
    furthest = std::max(furthest, std::abs(ledger.integrator_coriolis));
  }
  EXPECT_LT(furthest, 0.001 * ledger.initial);  // seen: 2e-4; 0.028 with the bias as it comes
  EXPECT_LT(std::abs(ledger.imbalance()), 1e-10 * ledger.initial);
}

/// The largest difference of a step's velocity from that of more passes, over time.settled, in
/// `duration` (s) of a stress scene at 2 ms; and the passes of a step, by the rule and by as many
/// as it takes.
struct Settling {
  double worst = 0;
  double passes = 0, all_passes = 0;
};
Settling settling_of(const std::string& name, double duration) {
  SceneRun run = stress_run(name, 0.002);
  const double tolerance = run.scene.time.settled;
  Scene patient = run.scene;
  patient.time.settled = 1e-9;
  StepRecord settled;
  Settling seen;
  while (run.time() < duration) {
    Simulation twin = run.sim;
    take_step(run.model, patient, twin, settled);
    const StepSolution& step = run.step().solution;
    const double off = (step.qdot - settled.solution.qdot).lpNorm<Eigen::Infinity>();
    seen.worst = std::max(seen.worst, off / tolerance);
    seen.passes += step.middle.passes;
    seen.all_passes += settled.solution.middle.passes;
  }
  std::cout << "[ FIGURE   ] " << name << ": off by " << seen.worst
            << " times time.settled; passes " << seen.passes << " of " << seen.all_passes << "\n";
  return seen;
}

// The share of a pass's change that remains is a guess from the steps before, and good to a factor.
TEST(Midpoint, KnowsWhatFurtherPassesWouldChange) {
  for (const char* name : {"whip", "spinning", "coil"}) {
    const Settling seen = settling_of(name, 1);
    EXPECT_LE(seen.worst, 3) << name;
    EXPECT_LE(seen.passes, 0.7 * seen.all_passes) << name;
  }
}

// Rows that the path of a step shows move its middle: it is found anew.
TEST(Midpoint, SettlesWithTheRowsOfItsPath) {
  SceneRun run = stress_run("pulled_knot", 0.01);
  int with_path_rows = 0;
  for (int i = 0; i < 30; ++i) {
    const StepSolution& step = run.step().solution;
    with_path_rows += step.path_rows.empty() ? 0 : 1;
    const double off = (step.qdot - step.middle.step_velocity).lpNorm<Eigen::Infinity>();
    EXPECT_LE(std::min(1.0, step.middle.remaining) * off, run.scene.time.settled) << i;
    EXPECT_EQ(step.middle.unsettled, 0) << i;
  }
  EXPECT_GE(with_path_rows, 10);
}

TEST(Midpoint, APassThatFailsLeavesTheStepToItsOwnFirstVelocity) {
  MidpointStage run(knotted(1, 3));
  for (int k = 0; k < 2; ++k) {  // the guess takes two
    run.step([](const StepInput&, const StepPlace&, const StepSolution& step) {
      EXPECT_EQ(step.middle.unsettled, 0);
    });
  }
  run.stage.solver.warm.half_change.setConstant(1e300);  // so far off that no pass is finite
  run.step([](const StepInput& in, const StepPlace& place, const StepSolution& step) {
    EXPECT_TRUE(std::isinf(step.middle.unsettled));
    EXPECT_EQ(place.velocity, in.state.qdot);
    EXPECT_TRUE(step.qdot.allFinite());
    EXPECT_TRUE(step.next.allFinite());
  });
}

// A second pass only where the first one's guess was poor; what does not settle is said.
TEST(Midpoint, SaysWhatDoesNotSettle) {
  MidpointStage run(knotted(1, 3));
  run.stage.scene.time.settled = 1e-12;
  run.stage.scene.time.passes = 1;
  run.step([](const StepInput&, const StepPlace& place, const StepSolution& step) {
    EXPECT_GT(step.middle.unsettled, 1e-12);
    // Neither did the passes without a balanced bias.
    EXPECT_EQ(step.middle.passes, 2);
    EXPECT_EQ(place.motion.bias_power, nullptr);
  });
}

}  // namespace hagfish::midpoint_test
