#include "core/run/energy.hpp"

namespace hagfish {
namespace {

void set_energies(const Model& model, const Moment& now, EnergyLedger& ledger) {
  ledger.kinetic = kinetic_energy(model, now.observation.kin);
  ledger.elastic = elastic_energy(model, now.state.q);
  ledger.gravity = gravity_energy(model, now.observation.kin);
}

/// Power lost to drag and damping at the step's velocity, erg/s.
double dissipation(const Model& model, const Kinematics& kin, const StepSolution& solution) {
  double power = 0;
  for (int b = 0; b < model.body_count(); ++b) {
    power += drag_power(model, kin, b, solution.twist.col(b), solution.centre_velocity.col(b));
  }
  for (int k = root_dofs; k < model.nv(); ++k) {
    power += model.hinges[k - root_dofs].damping * solution.qdot[k] * solution.qdot[k];
  }
  return power;
}

}  // namespace

EnergyLedger open_ledger(const Model& model, const Moment& now) {
  EnergyLedger ledger;
  set_energies(model, now, ledger);
  ledger.initial = ledger.kinetic + ledger.elastic + ledger.gravity;
  ledger.largest = ledger.kinetic + ledger.elastic;
  return ledger;
}

// The step solves M Δv = h (f - D v - K (q0 + h v) + w - b), Δv = v - v0, with the forces f,
// gravity w and the bias b of inertia, then moves by t v. With all forms of energy at their places,
//   T(q0, v) - T(q0, v0) = v'MΔv - ½ Δv'MΔv,    v'MΔv = (t/h) v'MΔv + (1 - t/h) v'MΔv,
//   (t/h) v'MΔv = t v'(f - D v) - t v'K q0 - t h v'K v + t v'w - t v'b,
//   V(q0 + t v) - V(q0) = t v'K q0 + ½ t² v'K v   of the springs.
// Their sum is works less dissipation, t v'(f - D v), and the integrator's own terms below.
void book_step(const Model& model, const Kinematics& kin, const StepSolution& solution,
               const Moment& next, double h, double travelled, EnergyLedger& ledger) {
  const double t = travelled;
  const Eigen::VectorXd& v = solution.qdot;
  const int last = model.body_count() - 1;
  ledger.work_tip += t * solution.tip.dot(solution.centre_velocity.col(last));
  ledger.work_active += t * solution.active_torque.dot(v);
  for (const RowKind kind : row_kinds) {
    ledger.work(kind) += t * solution.force[kind].dot(v);
  }
  ledger.dissipated += t * dissipation(model, kin, solution);

  double stretch = 0;  // v'K v
  for (int k = root_dofs; k < model.nv(); ++k) {
    stretch += model.hinges[k - root_dofs].stiffness * v[k] * v[k];
  }
  double change = 0;  // kinetic energy of the change of velocity
  double moved = 0;   // and of the new one, before the bodies move
  double fall = 0;    // work of gravity
  double bias = 0;    // and of what inertia asks for
  for (int b = 0; b < model.body_count(); ++b) {
    const Vector6d now = solution.twist.col(b);
    const Eigen::Vector3d velocity = solution.centre_velocity.col(b);
    change += kinetic_energy(model, kin, b, now - kin.twist.col(b),
                             velocity - kin.centre_velocity.col(b));
    moved += kinetic_energy(model, kin, b, now, velocity);
    fall += t * model.bodies[b].mass * model.gravity.dot(velocity);
    bias += t * (solution.system.bias.col(b).head<3>().dot(now.head<3>()) +
                 solution.system.bias.col(b).tail<3>().dot(velocity));
  }
  const double impulse_work = moved - ledger.kinetic + change;  // v'MΔv
  const double before = gravity_energy(model, kin);
  set_energies(model, next, ledger);
  ledger.integrator_inertia += (1 - t / h) * impulse_work - change;
  ledger.integrator_potential += (0.5 * t - h) * t * stretch + fall + ledger.gravity - before;
  ledger.integrator_coriolis += ledger.kinetic - moved - bias;
}

}  // namespace hagfish
