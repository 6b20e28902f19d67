// Impacts of a step of the midpoint rule, and the velocity after it.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/step/midpoint/midpoint_rule.hpp"

namespace hagfish {
namespace {

/// Rows that repeat each other make their Eq. 4 singular. This share of its largest diagonal entry
/// is added, which changes impacts by the same share.
constexpr double least_pivot = 1e-10;

/// Jumps of prescribed velocities below this, rad/s or cm/s, are rounding for the other rows.
constexpr double least_jump = 1e-9;

bool pushes(const Row& row, double lambda) {
  return lambda != 0 && lambda > row.lower && lambda < row.upper;
}

/// Computes the impacts of one step.
class Impacts {
 public:
  Impacts(const StepInput& in, const StepPlace& place, const RowProblem& problem,
          StepSolution& step)
      : in_(in), place_(place), problem_(problem), step_(step) {}

  /// The change of velocity by impacts, nv; empty without impacts. Throws std::domain_error as
  /// ArticulatedFactor::factorise does.
  const Eigen::VectorXd& change();

 private:
  bool find();
  void solve_impacts();
  void bound_impacts();
  void respond(const ArticulatedFactor& factor);
  bool release_pulling_limits();
  double coupling(Eigen::Index i, std::size_t row) const;

  const StepInput& in_;
  const StepPlace& place_;
  const RowProblem& problem_;
  StepSolution& step_;
  std::vector<std::size_t> prescribed_rows_;  ///< prescribed rows that push, and
  std::vector<PrescribedVelocity> jumps_;     ///< changes of their velocities
  std::vector<std::size_t> saturated_rows_;   ///< rows at their upper bound
  std::vector<std::size_t> impact_rows_;      ///< other rows with an impact
  std::vector<double> impact_b_, impact_x_;   ///< Eq. 4 of these rows, and its solution
  Matrix6Xd wrench_;                          ///< of all impacts except prescribed rows
  Eigen::VectorXd joint_;
  Eigen::VectorXd change_, reaction_;
  Matrix6Xd twist_;  ///< of the bodies at `change_`, 6 x N
};

/// Finds the rows that push. Where a force begins or stays, it stops the approach, so that the step
/// ends with the velocities that these rows ask for. Prescribed rows go into prescribed_rows_ and
/// jumps_, the others into impact_rows_, with their changes of velocity. Flesh stops nothing at
/// once. The force of a row at its upper bound acts at once (saturated_rows_). Returns false if no
/// velocity changes.
bool Impacts::find() {
  bool any = false;
  for (std::size_t i = 0; i < step_.rows.size(); ++i) {
    Row& row = step_.rows[i];
    const double lambda = step_.multipliers[static_cast<Eigen::Index>(i)];
    row.impact = 0;
    if (lambda >= row.upper) {
      row.impact = lambda;
      saturated_rows_.push_back(i);
      any = true;
    }
    if (!row.prescribed && (!pushes(row, lambda) || row.compliance > 0)) continue;
    const double change = row.rhs - row_velocity(row, place_.motion.before(), in_.state.qdot);
    any = any || change != 0;
    if (row.prescribed) {
      prescribed_rows_.push_back(i);
      jumps_.push_back({row.joint()->dof, row.joint()->sign * change});
    } else {
      impact_rows_.push_back(i);
      impact_b_.push_back(change);
    }
  }
  return any;
}

/// Solves A_impact μ = impact_b_ into impact_x_, with the same A as in Eq. 4.
void Impacts::solve_impacts() {
  const auto m = static_cast<Eigen::Index>(impact_rows_.size());
  Eigen::MatrixXd A(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index i = j; i < m; ++i) A(i, j) = coupling(i, impact_rows_[j]);
  }
  A.diagonal().array() += least_pivot * A.diagonal().maxCoeff();
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(A);
  impact_x_ = impact_b_;
  Eigen::Map<Eigen::VectorXd> x(impact_x_.data(), m);
  factor.solveInPlace(x);
}

/// A of the rows impact_rows_[i] and `row`.
double Impacts::coupling(Eigen::Index i, std::size_t row) const {
  const auto first = static_cast<std::size_t>(step_.prescribed);
  return problem_.qp.A(static_cast<Eigen::Index>(impact_rows_[i] - first),
                       static_cast<Eigen::Index>(row - first));
}

/// The impacts of the rows impact_rows_. A row whose force would be out of bounds keeps the bound,
/// and the others are solved again. Adds all of them to wrench_ and joint_.
void Impacts::bound_impacts() {
  for (bool again = true; again && !impact_rows_.empty();) {
    again = false;
    solve_impacts();
    for (std::size_t k = impact_rows_.size(); k-- > 0;) {
      const std::size_t i = impact_rows_[k];
      Row& row = step_.rows[i];
      const double lambda = 2 * step_.multipliers[static_cast<Eigen::Index>(i)];
      row.impact = std::clamp(impact_x_[k], lambda - row.upper, lambda - row.lower);
      if (row.impact == impact_x_[k]) continue;
      again = true;
      impact_rows_.erase(impact_rows_.begin() + static_cast<std::ptrdiff_t>(k));
      impact_x_.erase(impact_x_.begin() + static_cast<std::ptrdiff_t>(k));
      impact_b_.erase(impact_b_.begin() + static_cast<std::ptrdiff_t>(k));
      for (std::size_t j = 0; j < impact_rows_.size(); ++j) {
        impact_b_[j] -= coupling(static_cast<Eigen::Index>(j), i) * row.impact;
      }
      add_row(row, place_.kin, row.impact, wrench_, joint_);
    }
  }
  for (const std::size_t i : impact_rows_) {
    add_row(step_.rows[i], place_.kin, step_.rows[i].impact, wrench_, joint_);
  }
}

/// The change of velocity by the impacts of the rows impact_rows_ and the jumps of the prescribed
/// rows. Also the impacts of the latter.
void Impacts::respond(const ArticulatedFactor& factor) {
  factor.solve(in_.model, place_.kin, wrench_, joint_, jumps_, change_, twist_, reaction_);
  for (std::size_t k = 0; k < prescribed_rows_.size(); ++k) {
    Row& row = step_.rows[prescribed_rows_[k]];
    row.impact = row.joint()->sign * reaction_[static_cast<Eigen::Index>(k)];
  }
}

/// Releases prescribed limits that would pull over the whole step, without a force. Returns whether
/// there were any.
bool Impacts::release_pulling_limits() {
  std::size_t left = 0;
  for (std::size_t k = 0; k < prescribed_rows_.size(); ++k) {
    Row& row = step_.rows[prescribed_rows_[k]];
    const double lambda = 2 * step_.multipliers[static_cast<Eigen::Index>(prescribed_rows_[k])];
    if (lambda - row.impact < row.lower) {
      row.impact = lambda - row.lower;
      add_row(row, place_.kin, row.impact, wrench_, joint_);
    } else {
      prescribed_rows_[left] = prescribed_rows_[k];
      jumps_[left++] = jumps_[k];
    }
  }
  const bool any = left < prescribed_rows_.size();
  prescribed_rows_.resize(left);
  jumps_.resize(left);
  return any;
}

const Eigen::VectorXd& Impacts::change() {
  if (!find()) return change_;
  wrench_.setZero(6, in_.model.body_count());
  joint_.setZero(in_.model.nv());
  for (const std::size_t i : saturated_rows_) {
    add_row(step_.rows[i], place_.kin, step_.rows[i].impact, wrench_, joint_);
  }
  if (!impact_rows_.empty()) {
    // Saturated rows and jumps of prescribed velocities change the velocities of the other rows,
    // too. So impacts of the others have only the rest of the change to make.
    if (!saturated_rows_.empty() || std::ranges::any_of(jumps_, [](const auto& jump) {
          return std::abs(jump.value) > least_jump;
        })) {
      respond(problem_.factor);
      const Eigen::Matrix3Xd centre_velocity = centre_velocities(place_.kin, twist_);
      for (std::size_t k = 0; k < impact_rows_.size(); ++k) {
        impact_b_[k] -=
            row_velocity(step_.rows[impact_rows_[k]], {twist_, centre_velocity}, change_);
      }
    }
    bound_impacts();
  }
  respond(problem_.factor);
  // A limit that would pull over the whole step is let go. Its velocity is then free, which takes
  // another factorisation, and may make others pull. Each round frees at least one, so this ends.
  ArticulatedFactor free_factor;
  while (release_pulling_limits()) {
    free_factor.factorise(in_.model, place_.kin, step_.system.op, jumps_);
    respond(free_factor);
  }
  return change_;
}

}  // namespace

Status set_next_velocity(const StepInput& in, const StepPlace& place, const RowProblem& problem,
                         StepSolution& step, Eigen::VectorXd& half_change) {
  half_change = step.qdot - in.state.qdot;
  try {
    Impacts impacts(in, place, problem, step);
    if (const Eigen::VectorXd& change = impacts.change(); change.size() > 0) half_change -= change;
  } catch (const std::domain_error& error) {
    return {Outcome::non_finite, error.what()};
  }
  step.next = step.qdot + half_change;
  return {};
}

}  // namespace hagfish
