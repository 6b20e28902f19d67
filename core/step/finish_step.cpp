// Forces and residuals of a step as solved.
#include <algorithm>
#include <cmath>

#include "core/step/step.hpp"

namespace hagfish {
namespace {

/// λ, rows brought to unit diagonal, is kept for the next step above this share of the largest.
constexpr double active_share = 1e-6;

/// Eqs. 7 and 8: f = C'λ / h of one kind of row.
void sum_forces(RowKind kind, const Model& model, const Kinematics& kin, double h,
                StepScratch& scratch, StepSolution& step) {
  Eigen::VectorXd& force = step.force[kind];
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
}

/// step.net_force, and |H x - g - C'λ r / h| (x: felt; by Euler's rule q̇, r = h) over the largest
/// of the three: forces alone may be nothing but rounding.
double stationarity(const Model& model, const Kinematics& kin, double reach, StepScratch& scratch,
                    StepSolution& step) {
  const StepSystem& system = step.system;
  Eigen::VectorXd& momentum = scratch.joint;  // g, then with C'λ
  generalised_force(model, kin, system.wrench, momentum);
  momentum += system.joint;
  double scale = momentum.lpNorm<Eigen::Infinity>();
  Eigen::VectorXd& change = scratch.change;  // H x
  multiply(model, kin, system.op, step.felt, step.felt_twist, scratch.wrench, change);
  scale = std::max(scale, change.lpNorm<Eigen::Infinity>());
  step.net_force = (change - momentum) / reach + step.active_torque;
  step.force.total(scratch.impulse);
  scratch.impulse *= reach;
  scale = std::max(scale, scratch.impulse.lpNorm<Eigen::Infinity>());
  momentum += scratch.impulse;
  change -= momentum;
  return scale == 0 ? 0 : change.lpNorm<Eigen::Infinity>() / scale;
}

/// |λ| with rows brought to unit diagonal (prescribed ones to about that), so that those of cm/s
/// and rad/s compare, into scratch.scaled; what brings them there into scratch.row_scale.
void scale_multipliers(StepScratch& scratch, const StepSolution& step) {
  Eigen::VectorXd& scaled = scratch.scaled;
  scaled.resize(step.lambda.size());
  for (Eigen::Index i = 0; i < step.prescribed; ++i) {
    scaled[i] = 1 / std::sqrt(scratch.factor.pivot(step.rows[i].dof));
  }
  const Eigen::Index others = scaled.size() - step.prescribed;
  if (others > 0) {
    row_scale(scratch.qp().A, scaled.tail(others));
  }
  scratch.row_scale = scaled;
  scaled.array() *= step.lambda.array().abs();
}

/// Turns the multipliers of the velocity by which the step moves into those of its whole force
/// (core/README.md, "Steps in time").
void end_half(StepSolution& step) {
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    step.lambda[i] = 2 * step.lambda[i] - step.rows[i].impact;
  }
}

}  // namespace

/// Residuals of Eq. 4 and of the rows' excess C q̇ - d.
void StepSolver::measure_rows(StepSolution& step) {
  const auto m = static_cast<Eigen::Index>(step.rows.size());
  step.excess.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    step.excess[i] = row_velocity(step.rows[i], step.bodies(), step.qdot) - step.rows[i].rhs;
  }
  // β of the whole problem: where a prescribed row binds alone, b over its scale is this.
  const double beta = step.prescribed == 0 ? 0 : scratch_.scaled.head(step.prescribed).maxCoeff();
  const Eigen::Index others = m - step.prescribed;
  step.kkt = others == 0
                 ? KktResiduals{}
                 : kkt_residuals(scratch_.qp(), step.lambda.tail(others), step.excess.tail(others),
                                 scratch_.row_scale.tail(others), beta);
}

/// Keeps the multipliers of the rows with a force for the next step.
void StepSolver::keep_active(const StepSolution& step) {
  warm.begin();
  const Eigen::VectorXd& scaled = scratch_.scaled;
  const double least = scaled.size() > 0 ? active_share * scaled.maxCoeff() : 0;
  for (Eigen::Index i = 0; i < scaled.size(); ++i) {
    if (scaled[i] > least) {
      warm.add(step.rows[i].id, step.lambda[i]);
    }
  }
  warm.end();
}

void StepSolver::finish(const StepInput& in, StepSolution& step) {
  scale_multipliers(scratch_, step);
  measure_rows(step);
  keep_active(step);
  if (in.midway == nullptr) {
    step.felt = step.qdot;
    step.felt_twist = step.twist;
    step.felt_centre_velocity = step.centre_velocity;
  } else {
    step.felt = 0.5 * (in.state.qdot + step.next);
    body_twists(in.model, in.kin(), step.felt, step.felt_twist);
    centre_velocities(in.kin(), step.felt_twist, step.felt_centre_velocity);
    warm.half_before = warm.half_change;
    warm.half_change = scratch_.half_change;
    warm.remaining = step.remaining;
    end_half(step);
    step.middle.moved = in.midway->moved;
    step.middle.felt = in.midway->felt;
    step.middle_off = (step.qdot - step.middle.moved).norm();
  }
  const ActiveTorque& active = in.control.active;
  if (active.value.size() > 0) {
    step.active_torque = active.value - active.rate.cwiseProduct(step.felt);
  } else {
    step.active_torque.setZero(in.model.nv());
  }
  if (const ActiveTorque& torque = in.control.torque; torque.value.size() > 0) {
    step.active_torque += torque.value - torque.rate.cwiseProduct(step.felt);
  }
  for (const RowKind kind : row_kinds) {
    sum_forces(kind, in.model, in.kin(), in.scene.time.step, scratch_, step);
  }
  step.stationarity = stationarity(in.model, in.kin(), in.scene.time.reach(), scratch_, step);
  step.active = static_cast<int>((step.lambda.array() != 0).count());
  const int last = in.model.body_count() - 1;
  step.tip = in.control.tip.value - in.control.tip.rate * step.felt_centre_velocity.col(last);
}

}  // namespace hagfish
