#include "experiments/step_qp.hpp"

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

void RememberingSolver::solve(const BoxQp& qp, const Eigen::VectorXd& start,
                              BoxQpSolution& solution) {
  problem_ = qp;
  start_ = start;
  solver_->solve(qp, start, solution);
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

void to_primal(const Model& model, const StepRecord& record, const WarmStart& warm, StoredQp& qp) {
  const Kinematics& kin = record.situation.kin;
  const StepSystem& system = record.solution.system;
  const std::vector<Row>& rows = record.solution.rows;
  PrimalQp primal;
  primal.H = dense(model, kin, system.op);
  primal.g = generalised_force(model, kin, system.wrench) + system.joint;
  qp.start.resize(static_cast<Eigen::Index>(rows.size()));
  Eigen::Index filled = 0;
  const auto fill = [&](bool bilateral, Eigen::MatrixXd& C, Eigen::VectorXd& d) {
    const auto of_kind = [&](const Row& row) { return std::isinf(row.lower) == bilateral; };
    const auto m = std::count_if(rows.begin(), rows.end(), of_kind);
    C.resize(m, model.nv());
    d.resize(m);
    Eigen::Index k = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (of_kind(rows[i])) {
        C.row(k) = dense_row(model, kin, rows[i]).transpose();
        d[k++] = rows[i].rhs;
        const WarmStart::Kept* kept = warm.find(rows[i].id);
        qp.start[filled++] = kept == nullptr ? 0 : kept->lambda;
      }
    }
  };
  fill(true, primal.G, primal.e);
  fill(false, primal.C, primal.d);
  primal.cap = Eigen::VectorXd::Constant(primal.d.size(), std::numeric_limits<double>::infinity());
  qp.primal = std::move(primal);
}

}  // namespace hagfish
