#include "core/step/rounds.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <stdexcept>

#include "core/step/rows/prescribed_rows.hpp"
#include "core/step/rows/row_selection.hpp"

namespace hagfish {

Rounds::Rounds(std::string back_end)
    : back_end_(std::move(back_end)), solver_(make_box_qp_solver(back_end_)) {}

Rounds::Rounds(const Rounds& other)
    : back_end_(other.back_end_), solver_(make_box_qp_solver(back_end_)) {
  stop_when(other.stop_);
}

void Rounds::stop_when(std::function<bool()> asked) {
  stop_ = std::move(asked);
  solver_->stop_when(stop_);
}

Status Rounds::begin(const StepInput& in, const StepPlace& place, const WarmStart& warm,
                     StepSolution& step) {
  if (!in.state.q.allFinite() || !in.state.qdot.allFinite()) {
    return {Outcome::non_finite,
            "positions or velocities are not finite numbers; try a smaller time.step"};
  }
  const double reach = in.scene.time.reach();
  assemble_step_system(in.model, in.state, place.motion, place.kin, in.control.tip,
                       {reach, in.scene.time.spring_damping()}, step.system);
  add_active_torque(in.control.active, reach, step.system);
  add_active_torque(in.control.torque, reach, step.system);
  gather_rows(in, place, warm, step.rows);
  prescribe_rows(warm, step.rows);
  for (const PathRow& path_row : step.path_rows) put_row(placed_row(place, path_row), step.rows);
  step.kind = SolveKind::linear;
  step.iterations = 0;
  step.rounds = 0;
  step.qp_time = 0;
  step.prescribed = 0;
  factor_known_ = false;
  if (step.rows.empty()) {
    if (Status status = base_motion(in, place, step); !status.ok()) return status;
    if (!add_violated(in, place, step)) return {};
  }
  step.kind = SolveKind::kkt;
  return resume(in, place, warm, step);
}

/// Eq. 3 or 4 on step.rows, in rounds: violated rows are added, prescribed limits with λ < 0
/// released.
Status Rounds::resume(const StepInput& in, const StepPlace& place, const WarmStart& warm,
                      StepSolution& step) {
  do {
    if (Status status = round(in, place, warm, step); !status.ok()) return status;
  } while (change_rows(in, place, step));
  if (!step.qdot.allFinite()) {
    return {Outcome::non_finite,
            "velocities after the step are not finite numbers; try a smaller time.step"};
  }
  return {};
}

/// One round. If the rows cannot all be met with the prescribed ones, it repeats without any
/// prescribed row.
Status Rounds::round(const StepInput& in, const StepPlace& place, const WarmStart& warm,
                     StepSolution& step) {
  while (true) {
    order_rows(in.model, warm, step);
    ++step.rounds;
    if (!factor_is_current(step)) {
      if (Status status = base_motion(in, place, step); !status.ok()) return status;
    }
    const auto others = std::span(step.rows).subspan(static_cast<std::size_t>(step.prescribed));
    if (others.empty()) return {};
    step.multipliers.conservativeResize(static_cast<Eigen::Index>(step.rows.size()));
    step.multipliers.tail(problem_.start.size()) = problem_.start;
    assemble_dual(in.model, place.kin, problem_.factor, others, problem_.base,
                  problem_.base_bodies(), problem_.columns, problem_.qp);
    if (solve_multipliers(step)) {
      set_velocity(in, place, step);
      return {};
    }
    if (solution_.status == SolveStatus::stopped || !release_all(step)) {
      return describe_failure(in.model, problem_.qp, step.rows, solution_);
    }
  }
}

/// Whether the factor belongs to Eq. 1 and the rows that are prescribed now.
bool Rounds::factor_is_current(const StepSolution& step) const {
  return factor_known_ && static_cast<std::size_t>(std::ranges::count_if(
                              step.rows, &Row::prescribed)) == problem_.prescribed.size();
}

/// Releases rows and adds others as the solution requires. Returns whether it did.
bool Rounds::change_rows(const StepInput& in, const StepPlace& place, StepSolution& step) {
  const bool released = release_pulling(step);
  return add_violated(in, place, step) || released;
}

/// Sorts the rows by order_in_step, prescribed ones first. Collects start values of the multipliers
/// from the last round or, in the first, from the last step.
void Rounds::order_rows(const Model& model, const WarmStart& warm, StepSolution& step) {
  const std::size_t m = step.rows.size();
  // Rows of the last round, if there was one, come first and are already in order.
  const std::size_t solved =
      step.rounds > 0 ? static_cast<std::size_t>(step.multipliers.size()) : 0;
  order_.clear();
  step.prescribed = 0;
  for (std::size_t i = 0; i < m; ++i) {
    step.prescribed += step.rows[i].prescribed ? 1 : 0;
    order_.emplace_back(order_in_step(model, step.rows[i]), i);
  }
  std::ranges::sort(order_);
  ordered_.clear();
  problem_.start.resize(static_cast<Eigen::Index>(m) - step.prescribed);
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t i = order_[k].second;
    const Eigen::Index other = static_cast<Eigen::Index>(k) - step.prescribed;
    if (other >= 0) {
      problem_.start[other] = i < solved ? step.multipliers[i] : warm.multiplier(step.rows[i].id);
    }
    ordered_.push_back(std::move(step.rows[i]));
  }
  std::swap(step.rows, ordered_);
}

/// Eq. 1, H q̇* = M q̇0 + h f, or Eq. 3 with the prescribed rows.
Status Rounds::base_motion(const StepInput& in, const StepPlace& place, StepSolution& step) {
  prescribed_velocities(step, problem_.prescribed);
  try {
    problem_.factor.factorise(in.model, place.kin, step.system.op, problem_.prescribed);
  } catch (const std::domain_error& error) {
    return {Outcome::non_finite, error.what()};
  }
  step.multipliers.setZero(static_cast<Eigen::Index>(step.rows.size()));
  set_velocity(in, place, step);
  if (!step.qdot.allFinite()) {
    return {Outcome::non_finite,
            "velocities without constraints are not finite numbers; try a smaller time.step"};
  }
  problem_.base = step.qdot;
  problem_.base_twist = step.twist;
  problem_.base_centre_velocity = step.centre_velocity;
  factor_known_ = true;
  return {};
}

/// q̇ = H⁻¹ (g + C'λ) with the λ of the rows that are not prescribed. Also the twists of the
/// bodies, and the λ of the prescribed rows.
void Rounds::set_velocity(const StepInput& in, const StepPlace& place, StepSolution& step) {
  const Kinematics& kin = place.kin;
  wrench_ = step.system.wrench;
  joint_ = step.system.joint;
  for (auto i = static_cast<std::size_t>(step.prescribed); i < step.rows.size(); ++i) {
    if (step.multipliers[i] != 0) add_row(step.rows[i], kin, step.multipliers[i], wrench_, joint_);
  }
  problem_.factor.solve(in.model, kin, wrench_, joint_, step.qdot, step.twist, reaction_);
  centre_velocities(kin, step.twist, step.centre_velocity);
  for (Eigen::Index i = 0; i < step.prescribed; ++i) {
    step.multipliers[i] = step.rows[i].joint()->sign * reaction_[i];
  }
}

/// Eq. 4 on the rows that are not prescribed, as one small problem in the multipliers. False if the
/// back end fails, as it must if these rows contradict the prescribed ones.
bool Rounds::solve_multipliers(StepSolution& step) {
  BoxQpSolution& solution = solution_;
  step.kind = SolveKind::qp;
  const auto begin = std::chrono::steady_clock::now();
  solver_->solve(problem_.qp, problem_.start, solution);
  step.qp_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  step.iterations += solution.iterations;
  if (solution.status != SolveStatus::solved) return false;
  step.multipliers.tail(solution.x.size()) = solution.x;
  return true;
}

/// Adds rows that were left out and that q̇ violates. Returns whether there were any.
bool Rounds::add_violated(const StepInput& in, const StepPlace& place, StepSolution& step) {
  gather_violated_rows(in, place, step, violated_);
  bool any = false;
  for (const Row& row : violated_) {
    if (std::ranges::find(step.rows, row.id, &Row::id) == step.rows.end()) {
      step.rows.push_back(row);
      any = true;
    }
  }
  return any;
}

}  // namespace hagfish
