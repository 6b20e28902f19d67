#include "core/energy.hpp"

namespace hagfish {
namespace {

void set_energies(const Model& model, const State& state, const Kinematics& kin,
                  EnergyLedger& ledger) {
  ledger.kinetic = kinetic_energy(model, kin);
  ledger.elastic = elastic_energy(model, state.q);
  ledger.gravity = gravity_energy(model, kin);
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

EnergyLedger open_ledger(const Model& model, const State& state, const Kinematics& kin) {
  EnergyLedger ledger;
  set_energies(model, state, kin, ledger);
  ledger.initial = ledger.kinetic + ledger.elastic + ledger.gravity;
  ledger.largest = ledger.kinetic + ledger.elastic;
  return ledger;
}

void book_step(const Model& model, const Kinematics& kin, const StepSolution& solution,
               const State& next, const Kinematics& next_kin, double h, EnergyLedger& ledger) {
  const Eigen::VectorXd& v = solution.qdot;
  const int last = model.body_count() - 1;
  ledger.work_tip += h * solution.tip.dot(solution.centre_velocity.col(last));
  ledger.work_thigmotaxis += h * solution.force.thigmotaxis.dot(v);
  ledger.work_contact += h * solution.force.contact.dot(v);
  ledger.work_limit += h * solution.force.limit.dot(v);
  ledger.work_head += h * solution.force.head.dot(v);
  ledger.work_wall += h * solution.force.wall.dot(v);
  ledger.dissipated += h * dissipation(model, kin, solution);

  double stretch = 0;
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
    fall += h * model.bodies[b].mass * model.gravity.dot(velocity);
    bias += h * (solution.system.bias.col(b).head<3>().dot(now.head<3>()) +
                 solution.system.bias.col(b).tail<3>().dot(velocity));
  }
  const double before = gravity_energy(model, kin);
  set_energies(model, next, next_kin, ledger);
  ledger.integrator_inertia -= change;
  ledger.integrator_potential += -0.5 * h * h * stretch + fall + ledger.gravity - before;
  ledger.integrator_coriolis += ledger.kinetic - moved - bias;
}

}  // namespace hagfish
