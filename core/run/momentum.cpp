#include "core/run/momentum.hpp"

namespace hagfish {

Eigen::Vector3d linear_momentum(const Model& model, const Kinematics& kin) {
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  for (int b = 0; b < model.body_count(); ++b) {
    momentum += model.bodies[b].mass * kin.centre_velocity.col(b);
  }
  return momentum;
}

MomentumLedger open_momentum(const Model& model, const Moment& now) {
  MomentumLedger ledger;
  ledger.initial = linear_momentum(model, now.observation.kin);
  ledger.momentum = ledger.initial;
  return ledger;
}

// The root's linear rows of Eq. 1 say Σ m (v - v0) + h Σ bias = h Σ forces, with the velocities v
// of the bodies' centres at the new q̇ and the old positions, and forces of rows between two
// parts of the body, of joints and of muscles that add up to nothing.
void book_momentum(const Model& model, const Kinematics& kin, const StepSolution& solution,
                   const Moment& next, double h, MomentumLedger& ledger) {
  Eigen::Vector3d before_moving = Eigen::Vector3d::Zero();  // Σ m v
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  for (int b = 0; b < model.body_count(); ++b) {
    const Eigen::Vector3d velocity = solution.centre_velocity.col(b);
    before_moving += model.bodies[b].mass * velocity;
    bias += solution.system.bias.col(b).tail<3>();
    ledger.drag += h * drag_on_body(model, kin, b, velocity);
    ledger.outside += h * model.bodies[b].mass * model.gravity;
  }
  ledger.outside += h * (solution.tip + solution.force[RowKind::head].head<3>() +
                         solution.force[RowKind::wall].head<3>());
  ledger.momentum = linear_momentum(model, next.observation.kin);
  ledger.integrator += ledger.momentum - before_moving - h * bias;
}

}  // namespace hagfish
