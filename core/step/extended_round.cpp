// A round of a step that goes on with the factor of the round before.
#include <algorithm>
#include <span>

#include "core/step/prescribed_rows.hpp"
#include "core/step/step.hpp"

namespace hagfish {
namespace {

/// More new rows than two tiles of columns are left to a round from nothing. Affects speed only.
constexpr std::size_t most_new_rows = 2 * tile_rows;

}  // namespace

/// Puts released rows behind all others, and their λ in step.base into
/// scratch_.extension.reaction.
void StepSolver::move_released_back(StepSolution& step) {
  const auto prescribed = static_cast<std::size_t>(step.prescribed);
  scratch_.ordered.clear();
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    if (i >= prescribed || step.rows[i].prescribed) scratch_.ordered.push_back(step.rows[i]);
  }
  Eigen::VectorXd& reaction = scratch_.extension.reaction;
  reaction.resize(static_cast<Eigen::Index>(step.rows.size() - scratch_.ordered.size()));
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < prescribed; ++i) {
    if (step.rows[i].prescribed) continue;
    scratch_.ordered.push_back(step.rows[i]);
    reaction[next++] = scratch_.base_reaction[static_cast<Eigen::Index>(i)];
  }
  std::swap(step.rows, scratch_.ordered);
  step.prescribed -= next;
}

/// Eq. 4 again after a round from nothing, with rows that were added behind the others and
/// prescribed ones that were released, which then come last. False where that is left to a round
/// from nothing.
bool StepSolver::extended_round(const StepInput& in, StepSolution& step) {
  const Eigen::Index there = step.lambda.size() - step.prescribed;  // rows with a column
  const std::size_t added = step.rows.size() - static_cast<std::size_t>(step.lambda.size());
  const auto released = static_cast<std::size_t>(
      std::ranges::count(std::span(step.rows).first(static_cast<std::size_t>(step.prescribed)),
                         false, &Row::prescribed));
  if (!extends_rounds || in.midway != nullptr || there == 0 || added + released > most_new_rows) {
    return false;
  }
  scratch_.start.setZero(there + static_cast<Eigen::Index>(added + released));
  scratch_.start.head(there) = step.lambda.tail(there);
  for (std::size_t i = 0; i < added; ++i) {
    scratch_.start[there + static_cast<Eigen::Index>(i)] =
        warm.multiplier(step.rows[static_cast<std::size_t>(step.lambda.size()) + i].id);
  }
  move_released_back(step);
  ++step.rounds;
  const auto others =
      std::span<const Row>(step.rows).subspan(static_cast<std::size_t>(step.prescribed));
  const auto first_added = static_cast<std::size_t>(there);
  extend_dual(
      in.model, in.kin(), scratch_.factor,
      {others.first(first_added), others.subspan(first_added, added), others.last(released)},
      step.base, scratch_.base_bodies(), scratch_.columns, scratch_.whole, scratch_.extension);
  scratch_.extended = true;
  step.lambda.conservativeResize(static_cast<Eigen::Index>(step.rows.size()));
  step.lambda.tail(scratch_.start.size()) = scratch_.start;
  if (!solve_multipliers(step)) {
    return false;
  }
  // Released velocities come from the multipliers, as the factor has them pinned.
  const BoxQp& qp = scratch_.qp();
  for (std::size_t k = 0; k < released; ++k) {
    const Eigen::Index i = qp.b.size() - static_cast<Eigen::Index>(released - k);
    const Row& row = others[static_cast<std::size_t>(i)];
    const auto pin =
        std::ranges::lower_bound(scratch_.pinned, row.dof, {}, &PrescribedVelocity::dof);
    const double excess = qp.A.col(i).dot(scratch_.solution.x) - qp.b[i];
    pin->value = row.sign * (row.rhs + excess);
  }
  prescribed_velocities(step, scratch_.prescribed);
  set_velocity(in, step);
  return true;
}

}  // namespace hagfish
