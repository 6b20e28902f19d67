// Forces and residuals of a step as solved.
#include <algorithm>
#include <cmath>

#include "core/step/step.hpp"

namespace hagfish {
namespace {

/// λ, rows brought to unit diagonal, is kept for the next step above this share of the largest.
constexpr double active_share = 1e-6;

/// Eqs. 7 and 8: f = C'λ / h, by kind of row.
void sum_forces(const Model& model, const Kinematics& kin, double h, StepScratch& scratch,
                StepSolution& step) {
  const auto of_kind = [&](RowKind kind, Eigen::VectorXd& force) {
    bool on_bodies = false;
    scratch.joint.setZero(model.nv());
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      const Row& row = step.rows[i];
      if (row.kind == kind && step.lambda[i] != 0) {
        if (row.dof < 0 && !on_bodies) {
          scratch.wrench.setZero(6, model.body_count());
          on_bodies = true;
        }
        add_row(row, kin, step.lambda[i] / h, scratch.wrench, scratch.joint);
      }
    }
    if (on_bodies) {
      generalised_force(model, kin, scratch.wrench, force);
      force += scratch.joint;
    } else {
      force = scratch.joint;
    }
  };
  of_kind(RowKind::head, step.force.head);
  of_kind(RowKind::limit, step.force.limit);
  of_kind(RowKind::contact, step.force.contact);
  of_kind(RowKind::wall, step.force.wall);
  of_kind(RowKind::thigmotaxis, step.force.thigmotaxis);
}

/// step.net_force, and |H q̇ - g - C'λ| over the largest of the three: forces alone may be nothing
/// but rounding.
double stationarity(const Model& model, const Kinematics& kin, double h, StepScratch& scratch,
                    StepSolution& step) {
  const StepSystem& system = step.system;
  const ConstraintForces& f = step.force;
  Eigen::VectorXd& momentum = scratch.joint;  // g, then with C'λ
  generalised_force(model, kin, system.wrench, momentum);
  momentum += system.joint;
  double scale = momentum.lpNorm<Eigen::Infinity>();
  Eigen::VectorXd& change = scratch.change;  // H q̇
  multiply(model, kin, system.op, step.qdot, step.twist, scratch.wrench, change);
  scale = std::max(scale, change.lpNorm<Eigen::Infinity>());
  step.net_force = (change - momentum) / h;
  scratch.impulse = h * (f.head + f.limit + f.contact + f.wall + f.thigmotaxis);
  scale = std::max(scale, scratch.impulse.lpNorm<Eigen::Infinity>());
  momentum += scratch.impulse;
  change -= momentum;
  return scale == 0 ? 0 : change.lpNorm<Eigen::Infinity>() / scale;
}

/// |λ| with rows brought to unit diagonal (held ones to about that), so that those of cm/s and
/// rad/s compare, into scratch.scaled.
void scale_multipliers(StepScratch& scratch, const StepSolution& step) {
  Eigen::VectorXd& scaled = scratch.scaled;
  scaled.resize(step.lambda.size());
  for (Eigen::Index i = 0; i < step.held; ++i) {
    scaled[i] = 1 / std::sqrt(scratch.factor.pivot(step.rows[i].dof));
  }
  const Eigen::Index others = scaled.size() - step.held;
  if (others > 0) {
    row_scale(scratch.qp.A, scaled.tail(others));
  }
  scaled.array() *= step.lambda.array().abs();
}

/// Forces and residuals on the primal side: q̇ against H, and the rows' excess C q̇ - d.
void measure(const Model& model, const Kinematics& kin, double h, StepScratch& scratch,
             StepSolution& step) {
  const auto m = static_cast<Eigen::Index>(step.rows.size());
  step.excess.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    step.excess[i] = row_velocity(step.rows[i], step.centre_velocity, step.qdot) - step.rows[i].rhs;
  }
  // β of the whole problem: where a held row binds alone, b over its scale is this.
  const double beta = step.held == 0 ? 0 : scratch.scaled.head(step.held).maxCoeff();
  const Eigen::Index others = m - step.held;
  step.kkt = others == 0 ? KktResiduals{}
                         : kkt_residuals(scratch.qp, step.lambda.tail(others),
                                         step.excess.tail(others), beta);
  sum_forces(model, kin, h, scratch, step);
  step.stationarity = stationarity(model, kin, h, scratch, step);
}

/// Keeps the multipliers of the rows with a force for the next step.
void keep_active(const StepScratch& scratch, const StepSolution& step, WarmStart& warm) {
  warm.begin();
  const Eigen::VectorXd& scaled = scratch.scaled;
  const double least = scaled.size() > 0 ? active_share * scaled.maxCoeff() : 0;
  for (Eigen::Index i = 0; i < scaled.size(); ++i) {
    if (scaled[i] > least) {
      warm.add(step.rows[i].id, step.lambda[i]);
    }
  }
  warm.end();
}

}  // namespace

void finish_step(const Model& model, const Observation& observation, const Control& control,
                 const Scene& scene, WarmStart& warm, StepScratch& scratch, StepSolution& step) {
  scale_multipliers(scratch, step);
  measure(model, observation.kin, scene.time.step, scratch, step);
  keep_active(scratch, step, warm);
  step.active = static_cast<int>((step.lambda.array() != 0).count());
  const int last = model.body_count() - 1;
  step.tip = control.tip.value - control.tip.rate * step.centre_velocity.col(last);
}

}  // namespace hagfish
