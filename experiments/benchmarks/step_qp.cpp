#include "experiments/benchmarks/step_qp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hagfish {
namespace {

/// A multiplier this near its bound, over the bound, counts as at it: what back ends leave.
constexpr double near_cap = 1e-6;

}  // namespace

bool has_qp(const StepSolution& solution) {
  return std::ranges::any_of(solution.rows,
                             [](const Row& row) { return std::isfinite(row.lower); });
}

bool at_cap(const StepSolution& solution) {
  for (std::size_t i = 0; i < solution.rows.size(); ++i) {
    const double cap = solution.rows[i].upper;
    if (std::isfinite(cap) &&
        solution.lambda[static_cast<Eigen::Index>(i)] >= (1 - near_cap) * cap) {
      return true;
    }
  }
  return false;
}

PrimalQp to_primal(const Model& model, const Scene& scene, const StepRecord& record) {
  const ObservedState& now = record.after;
  const StepInput in{model, scene, now.state, now.observation, record.control};
  PrimalQp primal = paper_problem(in, start_of(in), record.solution.rows);
  primal.cap.setConstant(std::numeric_limits<double>::infinity());
  return primal;
}

Eigen::VectorXd kept_multipliers(const std::vector<Row>& rows, const WarmStart& warm) {
  Eigen::VectorXd lambda(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    lambda[static_cast<Eigen::Index>(i)] = warm.multiplier(rows[i].id);
  }
  return lambda;
}

}  // namespace hagfish
