// The velocity after a step of the midpoint rule (core/README.md, "Steps in time").
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/step/step.hpp"

namespace hagfish {
namespace {

/// Rows that repeat each other leave their Eq. 4 singular: this share of its largest diagonal entry
/// is added, which changes impacts by as little.
constexpr double least_pivot = 1e-10;

/// Velocities of prescribed rows that jump by less, rad/s or cm/s, are rounding to the other rows.
constexpr double least_jump = 1e-9;

bool pushes(const Row& row, double lambda) {
  return lambda != 0 && lambda > row.lower && lambda < row.upper;
}

}  // namespace

/// Rows that push: a force that begins or stays stops what comes, so that the step ends with the
/// velocities that they ask for. Prescribed ones go into scratch_.held and .jumps, the others into
/// scratch_.hit, with what their velocities change by. What a row at its upper bound has acts at
/// once: scratch_.full. False where no velocity changes.
bool StepSolver::find_impacts(const StepInput& in, StepSolution& step) {
  bool any = false;
  scratch_.held.clear();
  scratch_.jumps.clear();
  scratch_.full.clear();
  scratch_.hit.clear();
  scratch_.hit_b.clear();
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    Row& row = step.rows[i];
    const double lambda = step.lambda[static_cast<Eigen::Index>(i)];
    row.impact = 0;
    if (lambda >= row.upper) {
      row.impact = lambda;
      scratch_.full.push_back(i);
      any = true;
    }
    if (!row.prescribed && !pushes(row, lambda)) continue;
    const double change = row.rhs - row_velocity(row, in.motion().before(), in.state.qdot);
    any = any || change != 0;
    if (row.prescribed) {
      scratch_.held.push_back(i);
      scratch_.jumps.push_back({row.dof, row.sign * change});
    } else {
      scratch_.hit.push_back(i);
      scratch_.hit_b.push_back(change);
    }
  }
  return any;
}

/// Solves A_hit μ = scratch_.hit_b, of the same A as Eq. 4, into scratch_.hit_x.
void StepSolver::solve_hit(const StepSolution& step) {
  const auto m = static_cast<Eigen::Index>(scratch_.hit.size());
  scratch_.hit_A.resize(static_cast<std::size_t>(m * m));
  scratch_.hit_x = scratch_.hit_b;
  Eigen::Map<Eigen::MatrixXd> A(scratch_.hit_A.data(), m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index i = j; i < m; ++i) A(i, j) = coupling(step, i, scratch_.hit[j]);
  }
  A.diagonal().array() += least_pivot * A.diagonal().maxCoeff();
  Eigen::Ref<Eigen::MatrixXd> in_place(A);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(in_place);
  Eigen::Map<Eigen::VectorXd> x(scratch_.hit_x.data(), m);
  factor.solveInPlace(x);
}

/// A of the rows scratch_.hit[i] and `row`.
double StepSolver::coupling(const StepSolution& step, Eigen::Index i, std::size_t row) const {
  const auto first = static_cast<std::size_t>(step.prescribed);
  return scratch_.qp().A(static_cast<Eigen::Index>(scratch_.hit[i] - first),
                         static_cast<Eigen::Index>(row - first));
}

/// Impacts of the rows scratch_.hit. Those that would have a force that they may not have keep the
/// bound, and the others are solved again. Adds all to scratch_.wrench and scratch_.joint.
void StepSolver::solve_impacts(const StepInput& in, StepSolution& step) {
  for (bool again = true; again && !scratch_.hit.empty();) {
    again = false;
    solve_hit(step);
    for (std::size_t k = scratch_.hit.size(); k-- > 0;) {
      const std::size_t i = scratch_.hit[k];
      Row& row = step.rows[i];
      const double lambda = 2 * step.lambda[static_cast<Eigen::Index>(i)];
      row.impact = std::clamp(scratch_.hit_x[k], lambda - row.upper, lambda - row.lower);
      if (row.impact == scratch_.hit_x[k]) continue;
      again = true;
      scratch_.hit.erase(scratch_.hit.begin() + static_cast<std::ptrdiff_t>(k));
      scratch_.hit_x.erase(scratch_.hit_x.begin() + static_cast<std::ptrdiff_t>(k));
      scratch_.hit_b.erase(scratch_.hit_b.begin() + static_cast<std::ptrdiff_t>(k));
      for (std::size_t j = 0; j < scratch_.hit.size(); ++j) {
        scratch_.hit_b[j] -= coupling(step, static_cast<Eigen::Index>(j), i) * row.impact;
      }
      add_row(row, in.kin(), row.impact, scratch_.wrench, scratch_.joint);
    }
  }
  for (const std::size_t i : scratch_.hit) {
    add_row(step.rows[i], in.kin(), step.rows[i].impact, scratch_.wrench, scratch_.joint);
  }
}

/// What the velocity changes by in the impacts of the rows scratch_.hit and the jumps of the held
/// ones, and the impacts of those.
void StepSolver::respond(const StepInput& in, const ArticulatedFactor& factor, StepSolution& step) {
  factor.solve(in.model, in.kin(), scratch_.wrench, scratch_.joint, scratch_.jumps, scratch_.impact,
               scratch_.impact_twist, scratch_.reaction);
  for (std::size_t k = 0; k < scratch_.held.size(); ++k) {
    Row& row = step.rows[scratch_.held[k]];
    row.impact = row.sign * scratch_.reaction[static_cast<Eigen::Index>(k)];
  }
}

/// Held limits that would pull over the whole step are let go, with no force; whether there were
/// any.
bool StepSolver::release_held(const StepInput& in, StepSolution& step) {
  std::size_t left = 0;
  for (std::size_t k = 0; k < scratch_.held.size(); ++k) {
    Row& row = step.rows[scratch_.held[k]];
    const double lambda = 2 * step.lambda[static_cast<Eigen::Index>(scratch_.held[k])];
    if (lambda - row.impact < row.lower) {
      row.impact = lambda - row.lower;
      add_row(row, in.kin(), row.impact, scratch_.wrench, scratch_.joint);
    } else {
      scratch_.held[left] = scratch_.held[k];
      scratch_.jumps[left++] = scratch_.jumps[k];
    }
  }
  const bool any = left < scratch_.held.size();
  scratch_.held.resize(left);
  scratch_.jumps.resize(left);
  return any;
}

Status StepSolver::set_next_velocity(const StepInput& in, StepSolution& step) {
  step.next = step.qdot;
  if (in.midway == nullptr) {
    return {};
  }
  scratch_.half_change = step.qdot - in.state.qdot;
  if (find_impacts(in, step)) {
    const Kinematics& kin = in.kin();
    scratch_.wrench.setZero(6, in.model.body_count());
    scratch_.joint.setZero(in.model.nv());
    for (const std::size_t i : scratch_.full) {
      add_row(step.rows[i], kin, step.rows[i].impact, scratch_.wrench, scratch_.joint);
    }
    if (!scratch_.hit.empty()) {
      if (!scratch_.full.empty() || std::ranges::any_of(scratch_.jumps, [](const auto& jump) {
            return std::abs(jump.value) > least_jump;
          })) {
        respond(in, scratch_.factor, step);
        centre_velocities(kin, scratch_.impact_twist, scratch_.impact_centre_velocity);
        for (std::size_t k = 0; k < scratch_.hit.size(); ++k) {
          scratch_.hit_b[k] -= row_velocity(
              step.rows[scratch_.hit[k]], {scratch_.impact_twist, scratch_.impact_centre_velocity},
              scratch_.impact);
        }
      }
      solve_impacts(in, step);
    }
    respond(in, scratch_.factor, step);
    try {
      while (release_held(in, step)) {
        scratch_.free_factor.factorise(in.model, kin, step.system.op, scratch_.jumps);
        respond(in, scratch_.free_factor, step);
      }
    } catch (const std::domain_error& error) {
      return {Outcome::non_finite, error.what()};
    }
    scratch_.half_change -= scratch_.impact;
  }
  step.next += scratch_.half_change;
  return {};
}

}  // namespace hagfish
