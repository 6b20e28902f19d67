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

// The root's linear rows of Eq. 1 say Σ m (v' - v) + h Σ bias = h Σ forces, with the velocities v,
// v' of the bodies' centres before and after at the positions of the step's equations, and forces
// of rows between two parts of the body, of joints and of muscles that add up to nothing.
void book_momentum(const StepInput& in, const StepPlace& place, const StepSolution& step,
                   const Moment& next, MomentumLedger& ledger) {
  const Model& model = in.model;
  const double h = in.scene.time.step;
  const StepMotion& before = place.motion;
  const double whole = h / in.scene.time.reach();    // v' - v over what is felt of it
  Eigen::Vector3d change = Eigen::Vector3d::Zero();  // Σ m (v' - v)
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d drag = Eigen::Vector3d::Zero();
  double mass = 0;
  for (int b = 0; b < model.body_count(); ++b) {
    const Eigen::Vector3d felt = step.felt_centre_velocity.col(b);
    change += whole * model.bodies[b].mass * (felt - before.centre_velocity.col(b));
    bias += step.system.bias.col(b).tail<3>();
    drag += drag_on_body(model, place.kin, b, felt);
    mass += model.bodies[b].mass;
  }
  ledger.drag += h * drag;
  ledger.outside += h * (mass * model.gravity + step.tip + step.force[RowKind::head].head<3>() +
                         step.force[RowKind::wall].head<3>());
  const Eigen::Vector3d old = ledger.momentum;
  ledger.momentum = linear_momentum(model, next.observation.kin);
  ledger.integrator += ledger.momentum - old - change - h * bias;
}

}  // namespace hagfish
