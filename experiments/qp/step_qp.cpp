#include "experiments/qp/step_qp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hagfish {
namespace {

/// A multiplier this near its bound, over the bound, counts as at it: what back ends leave.
constexpr double near_cap = 1e-6;

/// One row of C, dense: C' of the row is its force per unit λ.
Eigen::VectorXd dense_row(const Model& model, const Kinematics& kin, const Row& row) {
  Matrix6Xd wrench = Matrix6Xd::Zero(6, model.body_count());
  Eigen::VectorXd joint = Eigen::VectorXd::Zero(model.nv());
  add_row(row, kin, 1, wrench, joint);
  return generalised_force(model, kin, wrench) + joint;
}

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

PrimalQp to_primal(const Model& model, const StepRecord& record) {
  const Kinematics& kin = record.observation.kin;
  const StepSystem& system = record.solution.system;
  const std::vector<Row>& rows = record.solution.rows;
  PrimalQp primal;
  primal.H = dense(model, kin, system.op);
  primal.g = generalised_force(model, kin, system.wrench) + system.joint;
  const auto fill = [&](bool bilateral, Eigen::MatrixXd& C, Eigen::VectorXd& d) {
    const auto of_kind = [&](const Row& row) { return std::isinf(row.lower) == bilateral; };
    const auto m = std::count_if(rows.begin(), rows.end(), of_kind);
    C.resize(m, model.nv());
    d.resize(m);
    Eigen::Index k = 0;
    for (const Row& row : rows) {
      if (of_kind(row)) {
        C.row(k) = dense_row(model, kin, row).transpose();
        d[k++] = row.rhs;
      }
    }
  };
  fill(true, primal.G, primal.e);
  fill(false, primal.C, primal.d);
  primal.cap = Eigen::VectorXd::Constant(primal.d.size(), std::numeric_limits<double>::infinity());
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
