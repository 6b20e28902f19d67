#include "core/step/step.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "core/step/prescribed_rows.hpp"
#include "core/step/row_selection.hpp"
#include "core/step/step_failure.hpp"

namespace hagfish {
namespace {

/// Less than this of a pass's change is never taken to remain.
constexpr double least_remaining = 1e-3;
constexpr double unlimited = std::numeric_limits<double>::infinity();

}  // namespace

void ConstraintForces::total(Eigen::VectorXd& sum) const {
  sum = of_kind[0];
  for (std::size_t k = 1; k < of_kind.size(); ++k) {
    sum += of_kind[k];
  }
}

Eigen::VectorXd ConstraintForces::total() const {
  Eigen::VectorXd sum;
  total(sum);
  return sum;
}

StepSolver::StepSolver(std::string back_end)
    : back_end_(std::move(back_end)), solver_(make_box_qp_solver(back_end_)) {}

StepSolver::StepSolver(const StepSolver& other)
    : warm(other.warm),
      extends_rounds(other.extends_rounds),
      back_end_(other.back_end_),
      solver_(make_box_qp_solver(back_end_)) {
  stop_when(other.stop_);
}

StepSolver& StepSolver::operator=(const StepSolver& other) {
  if (this != &other) {
    warm = other.warm;
    extends_rounds = other.extends_rounds;
    if (back_end_ != other.back_end_) {
      back_end_ = other.back_end_;
      solver_ = make_box_qp_solver(back_end_);
    }
    stop_when(other.stop_);
  }
  return *this;
}

void StepSolver::stop_when(std::function<bool()> asked) {
  stop_ = std::move(asked);
  solver_->stop_when(stop_);
}

Status StepSolver::begin(const StepInput& in, StepSolution& step) {
  step.unsettled = 0;
  step.remaining = 1;
  step.passes = 0;
  step.path_rows.clear();
  if (in.midway == nullptr) {
    return begin_here(in, step);
  }
  guess_middle(in);
  return settle(in, step);
}

/// The velocity that the middle is first placed by: as it changed in the last two steps.
void StepSolver::guess_middle(const StepInput& in) {
  const Eigen::Index nv = in.model.nv();
  scratch_.first_guess.resize(2 * nv);
  scratch_.first_guess.head(nv) = in.state.qdot;
  if (warm.half_before.size() > 0) {
    scratch_.first_guess.head(nv) += 2 * warm.half_change - warm.half_before;
  }
  scratch_.first_guess.tail(nv) = scratch_.first_guess.head(nv);
}

/// Passes from scratch_.first_guess on, and what is done where they do not settle.
Status StepSolver::settle(const StepInput& in, StepSolution& step) {
  // Where a balanced bias keeps the passes from settling, they may without.
  Status status = find_middle(in, true, step);
  const auto settled_or_stopped = [&] {
    return status.ok() ? step.unsettled == 0 : status.outcome == Outcome::stopped;
  };
  if (!settled_or_stopped()) {
    status = find_middle(in, false, step);
  }
  if (settled_or_stopped()) {
    return status;
  }
  // Passes that do not settle may run away, so far that one fails: the step is taken as from its
  // own first velocity.
  if (!status.ok()) step.unsettled = unlimited;
  Midway& midway = *in.midway;
  midway.moved = midway.felt = in.state.qdot;
  place_midway(in.model, in.state, in.observation.kin, in.scene.time.step, false, midway);
  step.remaining = 1;
  return begin_here(in, step);
}

/// Passes that place the step's middle until it has settled; step.unsettled where it does not.
Status StepSolver::find_middle(const StepInput& in, bool balanced, StepSolution& step) {
  const TimeSettings& time = in.scene.time;
  const Eigen::Index nv = in.model.nv();
  Midway& midway = *in.midway;
  midway.moved = scratch_.first_guess.head(nv);
  midway.felt = scratch_.first_guess.tail(nv);
  step.passes = balanced ? 0 : time.passes;
  step.unsettled = 0;
  step.remaining = guessed_remaining(warm.remaining);
  double before = 0;  // what the last pass changed
  scratch_.passes.restart();
  scratch_.placed_by.resize(2 * nv);
  scratch_.led_to.resize(2 * nv);
  for (int pass = 1;; ++pass) {
    ++step.passes;
    place_midway(in.model, in.state, in.observation.kin, time.step, balanced, midway);
    if (Status status = begin_here(in, step); !status.ok()) {
      return status;
    }
    const double off = (step.qdot - midway.moved).lpNorm<Eigen::Infinity>();
    if (pass > 1) {
      // Changes fall by a share θ each: what is left is off (θ + θ² + ...) = off θ / (1 - θ).
      step.remaining = off < before ? std::max(off / (before - off), least_remaining) : unlimited;
    }
    if (off == 0 || step.remaining * off <= time.settled) {
      return {};
    }
    before = off;
    if (pass >= time.passes) {
      step.unsettled = off;
      return {};
    }
    keep_pass(step);
    scratch_.placed_by << midway.moved, midway.felt;
    scratch_.led_to << step.qdot, 0.5 * (in.state.qdot + step.next);
    scratch_.passes.mix(scratch_.placed_by, scratch_.led_to, scratch_.mixed);
    midway.moved = scratch_.mixed.head(nv);
    midway.felt = scratch_.mixed.tail(nv);
  }
}

/// Eq. 1 and the rows where in.midway is, or at in.state.
Status StepSolver::begin_here(const StepInput& in, StepSolution& step) {
  if (!in.state.q.allFinite() || !in.state.qdot.allFinite()) {
    return {Outcome::non_finite, "non-finite state"};
  }
  const double reach = in.scene.time.reach();
  assemble_step_system(in.model, in.state, in.motion(), in.kin(), in.control.tip,
                       {reach, in.scene.time.spring_damping()}, step.system);
  add_active_torque(in.control.active, reach, step.system);
  add_active_torque(in.control.torque, reach, step.system);
  gather_rows(in, warm, step.rows);
  prescribe_rows(warm, step.rows);
  for (const PathRow& shown : step.path_rows) {
    put_row(placed_row(in, shown), step.rows);
  }
  step.kind = SolveKind::linear;
  step.iterations = 0;
  step.rounds = 0;
  step.qp_time = 0;
  step.prescribed = 0;
  scratch_.factor_known = false;
  if (step.rows.empty()) {
    if (Status status = base_motion(in, step); !status.ok()) {
      return status;
    }
    if (!add_violated(in, step)) {
      return set_next_velocity(in, step);
    }
  }
  step.kind = SolveKind::kkt;
  return constrained_motion(in, step);
}

Status StepSolver::resume(const StepInput& in, StepSolution& step) {
  Status status = constrained_motion(in, step);
  if (!status.ok() || in.midway == nullptr ||
      (step.qdot - in.midway->moved).lpNorm<Eigen::Infinity>() <= in.scene.time.settled) {
    return status;
  }
  keep_pass(step);
  scratch_.first_guess << step.qdot, 0.5 * (in.state.qdot + step.next);
  return settle(in, step);
}

/// Keeps the multipliers of a pass for the next one.
void StepSolver::keep_pass(const StepSolution& step) {
  warm.begin();
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    if (const double lambda = step.lambda[static_cast<Eigen::Index>(i)]; lambda != 0) {
      warm.add(step.rows[i].id, lambda);
    }
  }
  warm.end();
}

Status StepSolver::solve(const StepInput& in, StepSolution& step) {
  Status status = begin(in, step);
  if (status.ok()) {
    finish(in, step);
  }
  return status;
}

/// Eq. 3 or 4 on step.rows, in rounds: violated rows are added, prescribed limits with λ < 0
/// released, and the round after that goes on with the factor where that pays.
Status StepSolver::constrained_motion(const StepInput& in, StepSolution& step) {
  for (bool again = true; again;) {
    if (Status status = whole_round(in, step); !status.ok()) {
      return status;
    }
    again = change_rows(in, step);
    if (again && extended_round(in, step)) {
      again = change_rows(in, step);
    }
  }
  if (!step.qdot.allFinite()) {
    return {Outcome::non_finite, "non-finite velocity"};
  }
  return set_next_velocity(in, step);
}

/// A round from nothing but the base motion, where that is known. Where the rows cannot all be met
/// with those prescribed, another one, with none prescribed.
Status StepSolver::whole_round(const StepInput& in, StepSolution& step) {
  while (true) {
    order_rows(in.model, step);
    ++step.rounds;
    if (!factor_is_current(step)) {
      if (Status status = base_motion(in, step); !status.ok()) {
        return status;
      }
    }
    scratch_.extended = false;
    const auto others = std::span(step.rows).subspan(static_cast<std::size_t>(step.prescribed));
    if (others.empty()) {
      return {};
    }
    step.lambda.conservativeResize(static_cast<Eigen::Index>(step.rows.size()));
    step.lambda.tail(scratch_.start.size()) = scratch_.start;
    assemble_dual(in.model, in.kin(), scratch_.factor, others, step.base, scratch_.base_bodies(),
                  scratch_.columns, scratch_.whole);
    if (solve_multipliers(step)) {
      set_velocity(in, step);
      return {};
    }
    if (scratch_.solution.status == SolveStatus::stopped || !release_all(step)) {
      return describe_failure(in.model, scratch_.whole, step.rows, scratch_.solution);
    }
  }
}

/// Whether the factor is of Eq. 1 and the rows that are prescribed now.
bool StepSolver::factor_is_current(const StepSolution& step) const {
  return scratch_.factor_known && static_cast<std::size_t>(std::ranges::count_if(
                                      step.rows, &Row::prescribed)) == scratch_.pinned.size();
}

/// Releases rows and adds others where the solution asks for it; whether it did.
bool StepSolver::change_rows(const StepInput& in, StepSolution& step) {
  const bool released = release_pulling(step);
  return add_violated(in, step) || released;
}

/// Sorts the rows by their places, prescribed ones first, and gathers the multipliers to start
/// from: the last round's, or the last step's.
void StepSolver::order_rows(const Model& model, StepSolution& step) {
  const std::size_t m = step.rows.size();
  // Rows of the round before, if there was one, come first and are still in their places.
  const std::size_t solved = step.rounds > 0 ? static_cast<std::size_t>(step.lambda.size()) : 0;
  scratch_.order.clear();
  step.prescribed = 0;
  for (std::size_t i = 0; i < m; ++i) {
    step.prescribed += step.rows[i].prescribed ? 1 : 0;
    scratch_.order.emplace_back(place_in_step(model, step.rows[i]), i);
  }
  std::ranges::sort(scratch_.order);
  scratch_.ordered.clear();
  scratch_.start.resize(static_cast<Eigen::Index>(m) - step.prescribed);
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t i = scratch_.order[k].second;
    scratch_.ordered.push_back(step.rows[i]);
    const Eigen::Index place = static_cast<Eigen::Index>(k) - step.prescribed;
    if (place >= 0) {
      scratch_.start[place] = i < solved ? step.lambda[i] : warm.multiplier(step.rows[i].id);
    }
  }
  std::swap(step.rows, scratch_.ordered);
}

/// Eq. 1, H q̇* = M q̇0 + h f, or Eq. 3 with the prescribed rows.
Status StepSolver::base_motion(const StepInput& in, StepSolution& step) {
  prescribed_velocities(step, scratch_.prescribed);
  scratch_.pinned = scratch_.prescribed;
  try {
    scratch_.factor.factorise(in.model, in.kin(), step.system.op, scratch_.pinned);
  } catch (const std::domain_error& error) {
    return {Outcome::non_finite, error.what()};
  }
  step.lambda.setZero(static_cast<Eigen::Index>(step.rows.size()));
  set_velocity(in, step);
  if (!step.qdot.allFinite()) {
    return {Outcome::non_finite, "non-finite unconstrained velocity"};
  }
  step.base = step.qdot;
  scratch_.base_twist = step.twist;
  scratch_.base_centre_velocity = step.centre_velocity;
  scratch_.base_reaction = step.lambda.head(step.prescribed);
  scratch_.factor_known = true;
  return {};
}

/// q̇ = H⁻¹ (g + C'λ) with the λ of the rows that are not prescribed; with it the bodies' twists and
/// the λ of those that are.
void StepSolver::set_velocity(const StepInput& in, StepSolution& step) {
  const Kinematics& kin = in.kin();
  scratch_.wrench = step.system.wrench;
  scratch_.joint = step.system.joint;
  for (auto i = static_cast<std::size_t>(step.prescribed); i < step.rows.size(); ++i) {
    if (step.lambda[i] != 0) {
      add_row(step.rows[i], kin, step.lambda[i], scratch_.wrench, scratch_.joint);
    }
  }
  scratch_.factor.solve(in.model, kin, scratch_.wrench, scratch_.joint, scratch_.pinned, step.qdot,
                        step.twist, scratch_.reaction);
  centre_velocities(kin, step.twist, step.centre_velocity);
  Eigen::Index pinned = 0;  // released ones among them are passed over
  for (Eigen::Index i = 0; i < step.prescribed; ++i, ++pinned) {
    while (scratch_.pinned[pinned].dof != step.rows[i].dof) ++pinned;
    step.lambda[i] = step.rows[i].sign * scratch_.reaction[pinned];
  }
}

/// Eq. 4 on the rows that are not prescribed, as one small problem in the multipliers. False where
/// the back end failed, as it must where those contradict the prescribed ones.
bool StepSolver::solve_multipliers(StepSolution& step) {
  BoxQpSolution& solution = scratch_.solution;
  step.kind = SolveKind::qp;
  const auto begin = std::chrono::steady_clock::now();
  solver_->solve(scratch_.qp(), scratch_.start, solution);
  step.qp_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  step.iterations += solution.iterations;
  if (solution.status != SolveStatus::solved) {
    return false;
  }
  step.lambda.tail(solution.x.size()) = solution.x;
  return true;
}

/// Adds rows that were left out and that q̇ violates; whether there were any.
bool StepSolver::add_violated(const StepInput& in, StepSolution& step) {
  gather_violated_rows(in, step, scratch_.violated);
  bool any = false;
  for (const Row& row : scratch_.violated) {
    if (std::ranges::find(step.rows, row.id, &Row::id) == step.rows.end()) {
      step.rows.push_back(row);
      any = true;
    }
  }
  return any;
}

}  // namespace hagfish
