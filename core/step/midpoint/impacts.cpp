#include "core/step/midpoint/impacts.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

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
/// velocities that they ask for. Prescribed ones go into held_ and jumps_, the others into
/// hit_, with what their velocities change by. What a row at its upper bound has acts at
/// once: full_. False where no velocity changes.
bool Impacts::find(const StepInput& in, const StepPlace& place, StepSolution& step) {
  bool any = false;
  held_.clear();
  jumps_.clear();
  full_.clear();
  hit_.clear();
  hit_b_.clear();
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    Row& row = step.rows[i];
    const double lambda = step.lambda[static_cast<Eigen::Index>(i)];
    row.impact = 0;
    if (lambda >= row.upper) {
      row.impact = lambda;
      full_.push_back(i);
      any = true;
    }
    if (!row.prescribed && !pushes(row, lambda)) continue;
    const double change = row.rhs - row_velocity(row, place.motion.centre_velocity, in.state.qdot);
    any = any || change != 0;
    if (row.prescribed) {
      held_.push_back(i);
      jumps_.push_back({row.dof, row.sign * change});
    } else {
      hit_.push_back(i);
      hit_b_.push_back(change);
    }
  }
  return any;
}

/// Solves A_hit μ = hit_b_, of the same A as Eq. 4, into hit_x_.
void Impacts::solve_hit(const RowProblem& problem, const StepSolution& step) {
  const auto m = static_cast<Eigen::Index>(hit_.size());
  hit_A_.resize(static_cast<std::size_t>(m * m));
  hit_x_ = hit_b_;
  Eigen::Map<Eigen::MatrixXd> A(hit_A_.data(), m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index i = j; i < m; ++i) A(i, j) = coupling(problem, step, i, hit_[j]);
  }
  A.diagonal().array() += least_pivot * A.diagonal().maxCoeff();
  Eigen::Ref<Eigen::MatrixXd> in_place(A);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(in_place);
  Eigen::Map<Eigen::VectorXd> x(hit_x_.data(), m);
  factor.solveInPlace(x);
}

/// A of the rows hit_[i] and `row`.
double Impacts::coupling(const RowProblem& problem, const StepSolution& step, Eigen::Index i,
                         std::size_t row) const {
  const auto first = static_cast<std::size_t>(step.prescribed);
  return problem.qp.A(static_cast<Eigen::Index>(hit_[i] - first),
                        static_cast<Eigen::Index>(row - first));
}

/// Impacts of the rows hit_. Those that would have a force that they may not have keep the
/// bound, and the others are solved again. Adds all to wrench_ and joint_.
void Impacts::bound_hit(const StepPlace& place, const RowProblem& problem, StepSolution& step) {
  for (bool again = true; again && !hit_.empty();) {
    again = false;
    solve_hit(problem, step);
    for (std::size_t k = hit_.size(); k-- > 0;) {
      const std::size_t i = hit_[k];
      Row& row = step.rows[i];
      const double lambda = 2 * step.lambda[static_cast<Eigen::Index>(i)];
      row.impact = std::clamp(hit_x_[k], lambda - row.upper, lambda - row.lower);
      if (row.impact == hit_x_[k]) continue;
      again = true;
      hit_.erase(hit_.begin() + static_cast<std::ptrdiff_t>(k));
      hit_x_.erase(hit_x_.begin() + static_cast<std::ptrdiff_t>(k));
      hit_b_.erase(hit_b_.begin() + static_cast<std::ptrdiff_t>(k));
      for (std::size_t j = 0; j < hit_.size(); ++j) {
        hit_b_[j] -= coupling(problem, step, static_cast<Eigen::Index>(j), i) * row.impact;
      }
      add_row(row, place.kin, row.impact, wrench_, joint_);
    }
  }
  for (const std::size_t i : hit_) {
    add_row(step.rows[i], place.kin, step.rows[i].impact, wrench_, joint_);
  }
}

/// What the velocity changes by in the impacts of the rows hit_ and the jumps of the held
/// ones, and the impacts of those.
void Impacts::respond(const StepInput& in, const StepPlace& place, const ArticulatedFactor& factor,
                      StepSolution& step) {
  factor.solve(in.model, place.kin, wrench_, joint_, jumps_, impact_, impact_twist_, reaction_);
  for (std::size_t k = 0; k < held_.size(); ++k) {
    Row& row = step.rows[held_[k]];
    row.impact = row.sign * reaction_[static_cast<Eigen::Index>(k)];
  }
}

/// Held limits that would pull over the whole step are let go, with no force; whether there were
/// any.
bool Impacts::release_held(const StepPlace& place, StepSolution& step) {
  std::size_t left = 0;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    Row& row = step.rows[held_[k]];
    const double lambda = 2 * step.lambda[static_cast<Eigen::Index>(held_[k])];
    if (lambda - row.impact < row.lower) {
      row.impact = lambda - row.lower;
      add_row(row, place.kin, row.impact, wrench_, joint_);
    } else {
      held_[left] = held_[k];
      jumps_[left++] = jumps_[k];
    }
  }
  const bool any = left < held_.size();
  held_.resize(left);
  jumps_.resize(left);
  return any;
}

Status Impacts::set_next_velocity(const StepInput& in, const StepPlace& place,
                                  const RowProblem& problem, StepSolution& step) {
  step.next = step.qdot;
  half_change_ = step.qdot - in.state.qdot;
  if (find(in, place, step)) {
    const Kinematics& kin = place.kin;
    wrench_.setZero(6, in.model.body_count());
    joint_.setZero(in.model.nv());
    for (const std::size_t i : full_) {
      add_row(step.rows[i], kin, step.rows[i].impact, wrench_, joint_);
    }
    if (!hit_.empty()) {
      if (!full_.empty() || std::ranges::any_of(jumps_, [](const auto& jump) {
            return std::abs(jump.value) > least_jump;
          })) {
        respond(in, place, problem.factor, step);
        centre_velocities(kin, impact_twist_, impact_centre_velocity_);
        for (std::size_t k = 0; k < hit_.size(); ++k) {
          hit_b_[k] -= row_velocity(step.rows[hit_[k]], impact_centre_velocity_, impact_);
        }
      }
      bound_hit(place, problem, step);
    }
    respond(in, place, problem.factor, step);
    try {
      while (release_held(place, step)) {
        free_factor_.factorise(in.model, kin, step.system.op, jumps_);
        respond(in, place, free_factor_, step);
      }
    } catch (const std::domain_error& error) {
      return {Outcome::non_finite, error.what()};
    }
    half_change_ -= impact_;
  }
  step.next += half_change_;
  return {};
}

}  // namespace hagfish
