#include <algorithm>
#include <cmath>

#include "core/step/step_report.hpp"

namespace hagfish {
namespace {

/// The next step starts from all λ, scaled to rows of unit diagonal, above this share of the
/// largest.
constexpr double active_share = 1e-6;

/// Eqs. 7 and 8: f = C'λ / h of one kind of row.
void sum_forces(RowKind kind, const Model& model, const Kinematics& kin, double h,
                ReportStorage& storage, StepSolution& step) {
  Eigen::VectorXd& force = step.force[kind];
  bool on_bodies = false;
  storage.joint.setZero(model.nv());
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    const Row& row = step.rows[i];
    if (row.kind == kind && step.lambda[i] != 0) {
      if (row.joint() == nullptr && !on_bodies) {
        storage.wrench.setZero(6, model.body_count());
        on_bodies = true;
      }
      add_row(row, kin, step.lambda[i] / h, storage.wrench, storage.joint);
    }
  }
  if (on_bodies) {
    generalised_force(model, kin, storage.wrench, force);
    force += storage.joint;
  } else {
    force = storage.joint;
  }
}

/// Computes step.net_force, and |H x - g - C'λ r / h| over a scale (x: the mean velocity; by
/// Euler's rule q̇, r = h). The scale is the largest of the first two terms and of the force of
/// each kind alone. The sum of forces may be mere rounding, and all three terms are where forces
/// balance at rest.
double stationarity(const Model& model, const Kinematics& kin, double reach, ReportStorage& storage,
                    StepSolution& step) {
  const StepSystem& system = step.system;
  Eigen::VectorXd& momentum = storage.joint;  // g, then with C'λ
  generalised_force(model, kin, system.wrench, momentum);
  momentum += system.joint;
  double scale = momentum.lpNorm<Eigen::Infinity>();
  Eigen::VectorXd& change = storage.change;  // H x
  multiply(model, kin, system.op, step.mean_velocity, step.mean_twist, storage.wrench, change);
  scale = std::max(scale, change.lpNorm<Eigen::Infinity>());
  step.net_force = (change - momentum) / reach + step.active_torque;
  scale = std::max(scale, reach * step.active_torque.lpNorm<Eigen::Infinity>());
  for (const Eigen::VectorXd& force : step.force.of_kind) {
    scale = std::max(scale, reach * force.lpNorm<Eigen::Infinity>());
  }
  step.force.total(storage.impulse);
  storage.impulse *= reach;
  momentum += storage.impulse;
  change -= momentum;
  return scale == 0 ? 0 : change.lpNorm<Eigen::Infinity>() / scale;
}

/// Writes the sizes of the multipliers, scaled to rows of unit diagonal (prescribed rows: about
/// that), into storage.scaled, so that rows in cm/s and rad/s compare. Writes the scale into
/// storage.row_scale.
void scale_multipliers(const RowProblem& problem, const StepSolution& step,
                       ReportStorage& storage) {
  Eigen::VectorXd& scaled = storage.scaled;
  scaled.resize(step.multipliers.size());
  for (Eigen::Index i = 0; i < step.prescribed; ++i) {
    scaled[i] = 1 / std::sqrt(problem.factor.pivot(step.rows[i].joint()->dof));
  }
  const Eigen::Index solved = scaled.size() - step.prescribed;
  if (solved > 0) row_scale(problem.qp.A, scaled.tail(solved));
  storage.row_scale = scaled;
  scaled.array() *= step.multipliers.array().abs();
}

}  // namespace

void ConstraintForces::total(Eigen::VectorXd& sum) const {
  sum = of_kind[0];
  for (std::size_t k = 1; k < of_kind.size(); ++k) sum += of_kind[k];
}

Eigen::VectorXd ConstraintForces::total() const {
  Eigen::VectorXd sum;
  total(sum);
  return sum;
}

void measure_rows(const RowProblem& problem, ReportStorage& storage, StepSolution& step) {
  scale_multipliers(problem, step, storage);
  const auto m = static_cast<Eigen::Index>(step.rows.size());
  step.excess.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Row& row = step.rows[i];
    step.excess[i] = row_velocity(row, step.bodies(), step.qdot) - row.rhs +
                     (row.compliance > 0 ? row.compliance * step.multipliers[i] : 0);
  }
  // The scale of b over the whole problem: where a prescribed row binds alone, it is its b over its
  // scale.
  const double beta = step.prescribed == 0 ? 0 : storage.scaled.head(step.prescribed).maxCoeff();
  const Eigen::Index solved = m - step.prescribed;
  step.kkt = solved == 0
                 ? KktResiduals{}
                 : kkt_residuals(problem.qp, step.multipliers.tail(solved),
                                 step.excess.tail(solved), storage.row_scale.tail(solved), beta);
}

void keep_active(const ReportStorage& storage, const StepSolution& step, WarmStart& warm) {
  warm.begin();
  const Eigen::VectorXd& scaled = storage.scaled;
  const double least = scaled.size() > 0 ? active_share * scaled.maxCoeff() : 0;
  for (Eigen::Index i = 0; i < scaled.size(); ++i) {
    if (scaled[i] > least) warm.add(step.rows[i].id, step.multipliers[i]);
  }
  warm.end();
}

void report_forces(const StepInput& in, const StepPlace& place, ReportStorage& storage,
                   StepSolution& step) {
  const ActiveTorque& active = in.control.active;
  if (active.value.size() > 0) {
    step.active_torque = active.value - active.rate.cwiseProduct(step.mean_velocity);
  } else {
    step.active_torque.setZero(in.model.nv());
  }
  if (const ActiveTorque& torque = in.control.torque; torque.value.size() > 0) {
    step.active_torque += torque.value - torque.rate.cwiseProduct(step.mean_velocity);
  }
  for (const RowKind kind : row_kinds) {
    sum_forces(kind, in.model, place.kin, in.scene.time.step, storage, step);
  }
  step.stationarity = stationarity(in.model, place.kin, in.scene.time.reach(), storage, step);
  step.active = static_cast<int>((step.lambda.array() != 0).count());
  const TipForce& tip = in.control.tip;
  step.tip = tip.value - tip.rate * step.mean_centre_velocity.col(tip.on(in.model));
}

}  // namespace hagfish
