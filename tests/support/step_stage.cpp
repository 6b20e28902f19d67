#include "tests/support/step_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/step/paper_step.hpp"
#include "core/step/rows/flesh_rows.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/random_qp.hpp"
#include "tests/support/row_lists.hpp"

namespace hagfish {

Stage::Stage() : scene(table1_scene()), model(table1_hagfish()), state(rest_state(model)) {}

StepSolution Stage::solve() {
  StepSolution step;
  const Status status = solver.solve(input(observe(model, state, scene)), step);
  if (!status.ok()) throw StepError(status);
  return step;
}

std::vector<Row> Stage::rows() const {
  const Observation now = observe(model, state, scene);
  return every_row(input(now));
}

std::vector<Row> every_row(const StepInput& in) {
  const auto& [model, scene, state, now, control] = in;
  const double h = scene.time.step;
  std::vector<Row> all;
  const auto append = [&all](const std::vector<Row>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  if (control.clamp_head) append(head_rows(state, scene.constraints, h));
  append(thigmotaxis_rows(model, control.thigmotaxis, scene.controller, now.kin, h));
  append(limit_rows(model, state, scene.constraints, h));
  if (scene.flesh.present()) {
    append_flesh_rows(in, nullptr, {state.qdot, now.kin.velocities(), INFINITY, INFINITY}, all);
    return all;
  }
  append(contact_rows(model, now.contact, scene.constraints, h));
  append(plane_rows(model, now.kin, scene.constraints, h));
  return all;
}

Stage knotted(unsigned seed, double speed) {
  Random random(seed);
  Stage s;
  s.model.obstacles.clear();  // the knot passes x = 0
  s.state = knotted_state(random, s.model, 2.45, 0.002);
  s.state.qdot = random_entries(random, s.model.nv(), speed);
  s.control.tip = {random_vector(random, 1000), 0};
  const std::vector<Contact> contacts = observe(s.model, s.state, s.scene).contact.contacts;
  EXPECT_GE(contacts.size(), 3U);
  s.control.thigmotaxis = {{contacts.front(), {0, 0}}, {contacts.back(), {0.5, 2}}};
  return s;
}

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
  s.state = rest_state(s.model);
  return s;
}

namespace {

/// Errors of a solution against the paper's Eq. 4 with everything dense, rows left out included.
struct Optimality {
  double stationarity = 0;  ///< |H v - g - C'λ| over the larger of |g|, |C'λ|
  double feasibility = 0;   ///< how far a row falls short, cm/s or rad/s (soft rows by their cap)
  double sign = 0;          ///< how far a multiplier is outside its bounds
  double work = 0;          ///< Σ |λ (C v - d)| over Σ |λ| max |d|
};

Optimality optimality(const StepInput& in, const std::vector<Row>& all, const StepSolution& step) {
  const PrimalQp paper = paper_problem(in, start_of(in), all);
  const Eigen::MatrixXd c = dense_rows(in.model, in.observation.kin, all);
  const Eigen::VectorXd& g = paper.g;
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(c.rows());
  for (Eigen::Index i = 0; i < step.lambda.size(); ++i) {
    const auto it = std::find_if(all.begin(), all.end(),
                                 [&](const Row& row) { return row.id == step.rows[i].id; });
    EXPECT_NE(it, all.end());
    lambda[it - all.begin()] = step.lambda[i];
  }
  const Eigen::VectorXd impulse = c.transpose() * lambda;
  Optimality error;
  const Eigen::VectorXd change = paper.H * step.qdot - g;
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

}  // namespace

// A row left out may fall short by 1e-8; rows that are in are met to the back end's scaled 1e-10
// times the largest right-hand side, some 100 rad/s. Stationarity holds by construction, to
// rounding.
void expect_optimal(const StepInput& in, const StepSolution& step) {
  const Optimality error = optimality(in, every_row(in), step);
  EXPECT_LT(error.stationarity, 1e-9);
  EXPECT_LT(error.feasibility, 2e-8);
  EXPECT_LE(error.sign, 0);
  EXPECT_LT(error.work, 1e-7);
  EXPECT_LE(step.stationarity, 1e-9);
  EXPECT_LE(step.kkt.worst(), 1e-8);
}

void expect_optimal(const Stage& s, const StepSolution& step) {
  const Observation now = observe(s.model, s.state, s.scene);
  expect_optimal(s.input(now), step);
}

Eigen::VectorXd paper_velocity(const Stage& s) {
  const auto solve = [](const PrimalQp& qp) {
    const BoxQp dual = dual_of(qp);
    const BoxQpSolution solution =
        make_box_qp_solver("ipopt")->solve(dual, Eigen::VectorXd::Zero(dual.b.size()));
    EXPECT_EQ(solution.status, SolveStatus::solved);
    return velocity_of(qp, solution.x);
  };
  const Observation now = observe(s.model, s.state, s.scene);
  return paper_step(s.input(now), s.rows(), solve).qdot;
}

}  // namespace hagfish
