#include "core/step/step.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"

namespace hagfish {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// A scene, its model and a state, ready to step.
struct Stage {
  Scene scene = table1_scene();
  Model model = table1_hagfish();
  State state = rest_state(model);
  Control control;
  StepSolver solver{"ipopt"};

  /// Throws StepError where the step cannot be solved.
  StepSolution solve() {
    StepSolution step;
    const Status status =
        solver.solve({model, scene, state, observe(model, state, scene), control}, step);
    if (!status.ok()) throw StepError(status);
    return step;
  }

  /// Every row that the step may use, by its makers.
  std::vector<Row> rows() const {
    const Observation now = observe(model, state, scene);
    const double h = scene.time.step;
    std::vector<Row> all;
    const auto append = [&all](const std::vector<Row>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    if (control.clamp_head) append(head_rows(state, scene.constraints, h));
    append(
        thigmotaxis_rows(model, control.thigmotaxis, scene.controller, now.kin.centre_velocity, h));
    append(contact_rows(model, now.contact, scene.constraints, h));
    append(limit_rows(model, state, scene.constraints, h));
    append(wall_rows(model, now.kin, scene.wall, scene.constraints, h));
    return all;
  }
};

/// The hagfish in a knot whose three crossings touch, one of them 0.18 cm deep. It moves at random
/// and is pulled by the tail; thigmotaxis acts at the first and last contact.
Stage knotted(unsigned seed, double speed) {
  Random random(seed);
  Stage s;
  s.scene.wall.present = false;  // the knot passes x = 0
  s.state = knotted_state(random, s.model, 2.45, 0.002);
  s.state.qdot = random_entries(random, s.model.nv(), speed);
  s.control.tip = {random_vector(random, 1000), 0};
  const std::vector<Contact> contacts = observe(s.model, s.state, s.scene).contact.contacts;
  EXPECT_GE(contacts.size(), 3U);
  s.control.thigmotaxis = {{contacts.front(), {0, 0}}, {contacts.back(), {0.5, 2}}};
  return s;
}

/// Three bodies in a line with two hinges about Z between ±`limit`; head clamped.
Stage two_hinges(double limit) {
  Stage s;
  s.model = {};
  for (int b = 0; b < 3; ++b) {
    append_body(s.model, {1, 1, 0.1, cylinder_inertia(1, 1, 0.1), 0, 0},
                b == 0 ? std::vector<Axis>{} : std::vector<Axis>{Axis::z});
  }
  for (Hinge& hinge : s.model.hinges) {
    hinge.lower = -limit;
    hinge.upper = limit;
  }
  s.scene.wall.present = false;
  s.state = rest_state(s.model);
  return s;
}

/// Errors of a solution against the paper's Eq. 4 with everything dense, rows left out included.
struct Optimality {
  double stationarity = 0;  ///< |H v - g - C'λ| over the larger of |g|, |C'λ|
  double feasibility = 0;   ///< how far a row falls short, cm/s or rad/s (soft rows by their cap)
  double sign = 0;          ///< how far a multiplier is outside its bounds
  double work = 0;          ///< Σ |λ (C v - d)| over Σ |λ| max |d|
};

Optimality optimality(const Stage& s, const StepSolution& step) {
  const Kinematics kin = kinematics(s.model, s.state);
  const std::vector<Row> all = s.rows();
  const Eigen::MatrixXd c = dense_rows(s.model, kin, all);
  const StepSystem system = step_system(s.model, s.state, kin, s.control.tip, s.scene.time.step);
  const Eigen::VectorXd g = generalised_force(s.model, kin, system.wrench) + system.joint;
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(c.rows());
  for (Eigen::Index i = 0; i < step.lambda.size(); ++i) {
    const auto it = std::find_if(all.begin(), all.end(),
                                 [&](const Row& row) { return row.id == step.rows[i].id; });
    EXPECT_NE(it, all.end());
    lambda[it - all.begin()] = step.lambda[i];
  }
  const Eigen::VectorXd impulse = c.transpose() * lambda;
  Optimality error;
  const Eigen::VectorXd change = dense(s.model, kin, system.op) * step.qdot - g;
  error.stationarity = (change - impulse).lpNorm<Eigen::Infinity>() /
                       std::max(g.lpNorm<Eigen::Infinity>(), impulse.lpNorm<Eigen::Infinity>());
  const Eigen::VectorXd velocity = c * step.qdot;
  double size = 0;
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    const Row& row = all[i];
    const double excess = velocity[i] - row.rhs;
    const bool at_cap = std::isfinite(row.upper) && lambda[i] > row.upper * (1 - 1e-6);
    const bool bilateral = row.kind == RowKind::head;
    if (!at_cap) {
      error.feasibility = std::max(error.feasibility, bilateral ? std::abs(excess) : -excess);
      error.work += std::abs(lambda[i] * excess);
    }
    error.sign = std::max({error.sign, row.lower - lambda[i], lambda[i] - row.upper});
    size = std::max(size, std::abs(row.rhs));
  }
  error.work /= std::max(lambda.lpNorm<1>() * std::max(size, 1.0), 1e-300);
  return error;
}

// A row left out may fall short by 1e-8; rows that are in are met to the back end's scaled 1e-10
// times the largest right-hand side, some 100 rad/s. Stationarity holds by construction, to
// rounding.
void expect_optimal(const Stage& s, const StepSolution& step) {
  const Optimality error = optimality(s, step);
  EXPECT_LT(error.stationarity, 1e-9);
  EXPECT_LT(error.feasibility, 2e-8);
  EXPECT_LE(error.sign, 0);
  EXPECT_LT(error.work, 1e-7);
  EXPECT_LE(step.stationarity, 1e-9);
  EXPECT_LE(step.kkt.worst(), 1e-8);
}

TEST(Step, IsLinearWhereNoRowCanBind) {
  Stage s;
  s.state.q[0] = 100;  // far from the head plate
  s.control.clamp_head = false;
  s.control.tip.value << 0, 1, 0;
  const StepSolution step = s.solve();
  EXPECT_EQ(step.kind, SolveKind::linear);
  EXPECT_TRUE(step.rows.empty());
  EXPECT_EQ(step.rounds, 0);
  EXPECT_EQ(step.qdot, step.base);
  const Kinematics kin = kinematics(s.model, s.state);
  const Eigen::VectorXd g = generalised_force(s.model, kin, step.system.wrench) + step.system.joint;
  // The residual of a solve is rounding of its terms.
  EXPECT_LT(relative_error(dense(s.model, kin, step.system.op) * step.qdot, g), 1e-10);
  EXPECT_EQ(s.solver.warm.size(), 0U);
}

TEST(Step, IsBilateralWhereOnlyTheHeadIsClamped) {
  Stage s;
  s.state = bent_state(s.model, 0.02, 0.05);
  s.control.tip.value << 1, 1, 0;
  const StepSolution step = s.solve();
  EXPECT_EQ(step.kind, SolveKind::kkt);
  ASSERT_EQ(step.rows.size(), 6U);
  EXPECT_EQ(step.prescribed, 6);
  EXPECT_EQ(step.iterations, 0);
  EXPECT_EQ(step.qp_time, 0);
  expect_optimal(s, step);
  // The paper's Eq. 3, dense.
  const Kinematics kin = kinematics(s.model, s.state);
  const int nv = s.model.nv();
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(nv + 6, nv + 6);
  kkt.topLeftCorner(nv, nv) = dense(s.model, kin, step.system.op);
  kkt.bottomLeftCorner(6, nv) = dense_rows(s.model, kin, step.rows);
  kkt.topRightCorner(nv, 6) = -kkt.bottomLeftCorner(6, nv).transpose();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(nv + 6);
  right.head(nv) = generalised_force(s.model, kin, step.system.wrench) + step.system.joint;
  const Eigen::VectorXd expected = kkt.partialPivLu().solve(right);
  EXPECT_LT(relative_error(step.qdot, expected.head(nv)), 1e-8);  // condition of H times rounding
  EXPECT_LT(relative_error(step.lambda, expected.tail(6)), 1e-8);
}

TEST(Step, IsAQuadraticProgramWhereARowCanBind) {
  Stage s = knotted(91, 0.5);
  const StepSolution step = s.solve();
  EXPECT_EQ(step.kind, SolveKind::qp);
  EXPECT_GT(step.iterations, 1);
}

TEST(Step, IsOptimalAtEveryStepSize) {
  for (const double h : {5e-4, 2e-3, 1e-2, 5e-2}) {
    for (const unsigned seed : {92U, 93U, 94U}) {
      Stage s = knotted(seed, 1);
      s.scene.time.step = h;
      SCOPED_TRACE("h = " + std::to_string(h) + ", seed " + std::to_string(seed));
      expect_optimal(s, s.solve());
    }
  }
}

TEST(Step, IsOptimalWithThePositionScriptsSpring) {
  Stage s = knotted(95, 1);
  s.control.tip.rate = 26;
  const StepSolution step = s.solve();
  expect_optimal(s, step);
  const Kinematics kin = kinematics(s.model, s.state);
  const Eigen::Vector3d velocity = centre_jacobian(s.model, kin, 99) * step.qdot;
  EXPECT_LT(relative_error(step.tip, s.control.tip.value - 26 * velocity), 1e-12);
}

TEST(Step, IsOptimalAgainstTheHeadPlate) {
  Stage s;
  s.state.q[0] = -3;  // all bodies behind the neck start in the plate or near it
  s.control.clamp_head = false;
  s.control.tip.value << -500, 20, 0;
  const StepSolution step = s.solve();
  EXPECT_EQ(step.kind, SolveKind::qp);
  EXPECT_GT(step.force[RowKind::wall].lpNorm<Eigen::Infinity>(), 0);
  expect_optimal(s, step);
}

TEST(Step, ForcesByKindAddUpToTheRows) {
  Stage s = knotted(96, 1);
  const StepSolution step = s.solve();
  const Kinematics kin = kinematics(s.model, s.state);
  const double h = s.scene.time.step;
  for (const RowKind kind : row_kinds) {
    const Eigen::VectorXd& force = step.force[kind];
    Eigen::VectorXd lambda = step.lambda / h;  // Eq. 8
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      if (step.rows[i].kind != kind) lambda[static_cast<Eigen::Index>(i)] = 0;
    }
    const Eigen::VectorXd expected = dense_rows(s.model, kin, step.rows).transpose() * lambda;
    // Terms of opposite strands cancel: rounding of the largest term, not of the sum.
    const double scale = step.force.total().lpNorm<Eigen::Infinity>();
    EXPECT_LT((force - expected).lpNorm<Eigen::Infinity>() / scale, 1e-12);
  }
}

TEST(Step, NoForceBehindTheLastContact) {
  Stage s = knotted(97, 1);
  for (ThigmotaxisCommand& command : s.control.thigmotaxis) command.speed = {50, 50};
  const StepSolution step = s.solve();
  int last = 0;
  for (const Row& row : step.rows) {
    if (row.kind != RowKind::contact && row.kind != RowKind::thigmotaxis) continue;
    visit_forces(row, [&](int body, const Eigen::Vector3d&) { last = std::max(last, body); });
  }
  ASSERT_LT(last, 99);
  const Eigen::Index behind = s.model.nv() - s.model.bodies[last + 1].first_dof;
  EXPECT_GT(step.force[RowKind::thigmotaxis].lpNorm<Eigen::Infinity>(), 0);
  EXPECT_EQ(step.force[RowKind::contact].tail(behind), Eigen::VectorXd::Zero(behind));  // exactly
  EXPECT_EQ(step.force[RowKind::thigmotaxis].tail(behind), Eigen::VectorXd::Zero(behind));
}

TEST(Step, StationarityStaysSmallWhereTheClampHardlyPulls) {
  // Across a straight body a pull at the tail hardly reaches the head: its force is 1e-40 dyn, and
  // what rounding leaves of H q̇ is larger.
  Stage s;
  s.control.tip.value << 0, 1, 0;
  EXPECT_LE(s.solve().stationarity, 1e-9);
}

TEST(Step, ClampKeepsTheHeadInPlace) {
  Stage s = knotted(98, 1);
  s.control.thigmotaxis.clear();
  for (int k = 0; k < 25; ++k) {
    const StepSolution step = s.solve();
    s.state.qdot = step.qdot;
    s.state.q = advance(s.state.q, step.qdot, s.scene.time.step);
    // What the solver leaves of the head's velocity, 1e-8 of the largest, over 25 steps of 2 ms.
    EXPECT_LT(head_drift(s.model, kinematics(s.model, s.state)), 1e-8) << k;
  }
}

TEST(Step, ClampTakesADriftBack) {
  Stage s;
  s.state.q[1] = 1e-3;
  s.state.q[5] = 5e-4;  // half the sine of a turn about Y
  s.state.q.segment<4>(3).normalize();
  const double start = head_drift(s.model, kinematics(s.model, s.state));
  const StepSolution step = s.solve();
  s.state.q = advance(s.state.q, step.qdot, s.scene.time.step);
  // A share of 0.5 of both; the sine of a turn of 1e-3 is off by 1e-7 of it.
  EXPECT_NEAR(head_drift(s.model, kinematics(s.model, s.state)) / start, 0.5, 1e-5);
}

TEST(Step, WarmStartKeepsTheRowsWithAForce) {
  Stage s = knotted(99, 1);
  const StepSolution cold = s.solve();
  ASSERT_GT(cold.active, 0);
  EXPECT_EQ(s.solver.warm.size(), static_cast<std::size_t>(cold.active));
  for (std::size_t i = 0; i < cold.rows.size(); ++i) {
    const WarmStart::Kept* kept = s.solver.warm.find(cold.rows[i].id);
    if (kept != nullptr) {
      EXPECT_EQ(kept->lambda, cold.lambda[static_cast<Eigen::Index>(i)]);
    }
  }
  // The answer does not depend on the guess: solver tolerance.
  const StepSolution warm = s.solve();
  EXPECT_LT(relative_error(warm.qdot, cold.qdot), 1e-7);
  s.solver.warm.add(12345, 1e9);  // a row that is no more
  s.solver.warm.end();
  EXPECT_LT(relative_error(s.solve().qdot, cold.qdot), 1e-7);
  EXPECT_EQ(s.solver.warm.find(12345), nullptr);
}

/// The velocity with every row in from the start, by dense algebra.
Eigen::VectorXd all_rows_in(const Stage& s) {
  const Kinematics kin = kinematics(s.model, s.state);
  const std::vector<Row> rows = s.rows();
  const StepSystem system = step_system(s.model, s.state, kin, s.control.tip, s.scene.time.step);
  const Eigen::LLT<Eigen::MatrixXd> factor(dense(s.model, kin, system.op));
  const Eigen::VectorXd g = generalised_force(s.model, kin, system.wrench) + system.joint;
  const Eigen::MatrixXd c = dense_rows(s.model, kin, rows);
  BoxQp qp;
  qp.A = c * factor.solve(c.transpose());
  const auto m = static_cast<Eigen::Index>(rows.size());
  qp.b.resize(m);
  qp.lower.resize(m);
  qp.upper.resize(m);
  const Eigen::VectorXd unconstrained = c * factor.solve(g);
  for (Eigen::Index i = 0; i < m; ++i) {
    qp.b[i] = rows[i].rhs - unconstrained[i];
    qp.lower[i] = rows[i].lower;
    qp.upper[i] = rows[i].upper;
  }
  const BoxQpSolution solution = make_box_qp_solver("ipopt")->solve(qp, Eigen::VectorXd::Zero(m));
  EXPECT_EQ(solution.status, SolveStatus::solved);
  return factor.solve(g + c.transpose() * solution.x);
}

TEST(Step, RowsLeftOutComeInWhereTheAnswerViolatesThem) {
  // The first hinge runs into its limit; the shock flings the second one, which was slow and clear
  // of its own, past it within the step.
  Stage s = two_hinges(0.5);
  s.model.hinges[0].upper = 0;
  s.scene.time.step = 0.05;
  s.state.qdot[6] = 8;
  const StepSolution step = s.solve();
  EXPECT_GT(step.rounds, 1);
  expect_optimal(s, step);
  EXPECT_LT(relative_error(step.qdot, all_rows_in(s)), 1e-7);  // solver tolerance
  EXPECT_NEAR(step.qdot[7], 10, 1e-5);                         // to its limit in one step
}

TEST(Step, LeavingRowsOutChangesNothing) {
  for (const unsigned seed : {101U, 102U}) {
    Stage s = knotted(seed, 20);
    s.scene.time.step = 0.02;
    const StepSolution step = s.solve();
    EXPECT_LT(step.rows.size(), s.rows().size());
    // The multipliers may be shared otherwise, the velocity is unique: to the condition of H times
    // rounding, and to what a row left out may fall short, 1e-8 rad/s of 20.
    EXPECT_LT(relative_error(step.qdot, all_rows_in(s)), 1e-8) << seed;
    expect_optimal(s, step);
  }
}

/// A warm start in which these limits have pushed as hard for two steps.
WarmStart steady(const std::vector<Row>& rows) {
  WarmStart warm;
  for (int k = 0; k < 2; ++k) {
    warm.begin();
    for (const Row& row : rows) {
      if (row.kind == RowKind::limit) warm.add(row.id, 1);
    }
    warm.end();
  }
  return warm;
}

TEST(Step, PrescribesLimitsThatPushSteadily) {
  Stage s = knotted(106, 1);
  int limits = 0;
  for (int k = 0; k < 20; ++k) {
    SCOPED_TRACE(k);
    const StepSolution step = s.solve();
    expect_optimal(s, step);
    EXPECT_LT(relative_error(step.qdot, all_rows_in(s)), 1e-7);  // solver tolerance
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      EXPECT_EQ(step.rows[i].prescribed, static_cast<Eigen::Index>(i) < step.prescribed);
      if (step.rows[i].prescribed) {
        EXPECT_EQ(step.excess[static_cast<Eigen::Index>(i)], 0) << "met exactly";
        limits += step.rows[i].kind == RowKind::limit ? 1 : 0;
      }
    }
    s.state.qdot = step.qdot;
    s.state.q = advance(s.state.q, step.qdot, s.scene.time.step);
  }
  EXPECT_GT(limits, 20);
}

TEST(Step, ReleasesPrescribedLimitsThatWouldHaveToPull) {
  Stage s = knotted(107, 20);
  s.scene.time.step = 0.02;  // limits are in reach
  const StepSolution cold = s.solve();
  const auto resting =
      std::ranges::count_if(cold.rows, [](const Row& row) { return row.kind == RowKind::limit; });
  ASSERT_GT(resting, 3);
  s.solver.warm = steady(cold.rows);
  const StepSolution step = s.solve();
  EXPECT_GT(step.rounds, 1);
  EXPECT_LT(step.prescribed, 6 + resting);
  EXPECT_GT(step.prescribed, 6);
  expect_optimal(s, step);
  EXPECT_LT(relative_error(step.qdot, cold.qdot), 1e-7);  // solver tolerance
}

TEST(Step, ReleasesPrescribedLimitsThatContradictOtherRows) {
  // With both hinges prescribed the plate could not push the last body out.
  Stage s = two_hinges(3);
  s.model.hinges[0].upper = 2.5;
  s.model.hinges[1].upper = 0.5;
  s.state.q[7] = 2.5;
  s.state.q[8] = 0.5;
  s.scene.wall.present = true;
  s.scene.wall.neck = 2;
  const StepSolution cold = s.solve();
  ASSERT_GT(cold.force[RowKind::wall].norm(), 0);
  s.solver.warm = steady(s.rows());
  const StepSolution step = s.solve();
  EXPECT_GT(step.rounds, 1);
  EXPECT_EQ(step.prescribed, 0);
  expect_optimal(s, step);
  EXPECT_LT(relative_error(step.qdot, cold.qdot), 1e-7);  // solver tolerance
}

TEST(Step, CapsThigmotaxisForces) {
  Stage s = knotted(103, 0);
  s.scene.controller.acceleration = 1e8;  // at once
  for (ThigmotaxisCommand& command : s.control.thigmotaxis) command.speed = {1e4, 1e4};
  const StepSolution step = s.solve();
  double largest = 0;
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    if (step.rows[i].kind == RowKind::thigmotaxis) {
      largest = std::max(largest, step.lambda[static_cast<Eigen::Index>(i)] / s.scene.time.step);
    }
  }
  EXPECT_LE(largest, 5000);
  EXPECT_GT(largest, 4999);
}

TEST(Step, NamesRowsThatContradictEachOther) {
  // The clamp holds a head that the plate, without a neck to let it through, wants to push out.
  for (const std::string& name : box_qp_solver_names()) {
    Stage s;
    s.scene.wall.neck = 0;
    s.solver = StepSolver(name);
    const Observation now = observe(s.model, s.state, s.scene);
    StepSolution step;
    const Status status = s.solver.solve({s.model, s.scene, s.state, now, s.control}, step);
    EXPECT_EQ(status.outcome, Outcome::infeasible) << status.message;
    EXPECT_EQ(status.message.find("rows contradict each other: head clamp, velocity 0; head plate "
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

}  // namespace
}  // namespace hagfish
