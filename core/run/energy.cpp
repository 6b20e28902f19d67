#include "core/run/energy.hpp"

#include <algorithm>

#include "core/run/momentum.hpp"

namespace hagfish {
namespace {

void set_energies(const Model& model, const ObservedState& now, EnergyLedger& ledger) {
  ledger.kinetic = kinetic_energy(model, now.observation.kin);
  ledger.elastic = elastic_energy(model, now.state.q) + now.observation.flesh.energy;
  ledger.gravity = gravity_energy(model, now.observation.kin);
}

/// What the integrator makes in this step of the translation of a body that keeps its momentum,
/// erg: of ½ M V² and of the energy in gravity, beyond the work of what acts from outside on the
/// centre of mass. What bears on an obstacle has its frame of reference: then it is only what will
/// be taken as momentum is given back. `fallen`: the change of the energy in gravity.
double made_of_translation(const StepInput& in, const StepPlace& place, const StepSolution& step,
                           const ObservedState& next, double travelled, double fallen) {
  const Model& model = in.model;
  const double mass = model.mass();
  Eigen::Vector3d force = step.tip + step.force[RowKind::obstacle].head<3>();
  for (int b = 0; b < model.body_count(); ++b) {
    force += drag_on_body(model, place.kin, b, body_motion(step.mean_bodies(), b)).force;
  }
  const Eigen::Vector3d before = mean_by_mass(model, in.observation.kin.centre_velocity);
  const Eigen::Vector3d after = mean_by_mass(model, next.observation.kin.centre_velocity);
  const auto made_since = [&](const Eigen::Vector3d& velocity) {
    return 0.5 * mass * (after - velocity).dot(after + velocity);
  };
  if (!step.force[RowKind::obstacle].isZero(0)) {
    return made_since(before + in.scene.time.step * (force / mass + model.gravity));
  }
  return made_since(before) + fallen -
         travelled * force.dot(mean_by_mass(model, step.centre_velocity));
}

/// The loss by impacts of a step by Euler's rule.
double lost_at_impacts(const StepInput& in, const StepPlace& place, const StepSolution& step) {
  const BodyVelocities before = place.motion.before();
  double lost = 0;
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    const Row& row = step.rows[i];
    const double lambda = step.lambda[static_cast<Eigen::Index>(i)];
    if (row.kind == RowKind::thigmotaxis || lambda == 0 || row.compliance > 0) continue;
    const double change =
        row_velocity(row, step.bodies(), step.qdot) - row_velocity(row, before, in.state.qdot);
    lost += std::max(0.0, 0.5 * lambda * change);
  }
  return lost;
}

/// Takes the forces of flesh out of the works of rows: what they do is stored, as elastic energy,
/// or lost in their dampers. Flesh that is left faster than it relaxes pushes nothing, and all that
/// it gives up is lost. Returns the work by the law, and adds to `lost`, both over `travelled` (s).
double book_flesh(const StepInput& in, const StepSolution& step, double travelled,
                  ByKind<double>& works, double& lost) {
  const double reach = in.scene.time.reach(), relaxation = in.scene.flesh.relaxation;
  double work = 0;
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    const Row& row = step.rows[i];
    const double force = step.lambda[static_cast<Eigen::Index>(i)] / in.scene.time.step;
    if (row.compliance == 0) continue;
    const double speed = row_velocity(row, step.bodies(), step.qdot);
    if (force > 0) {
      works[row.kind] -= travelled * force * speed;
      work += travelled * (row.rhs - speed) / (row.compliance * reach) * speed;
      lost += travelled * row.damper * speed * speed;
    } else if (row.damper > 0) {
      const double gap = -row.rhs * (0.5 * in.scene.time.step + relaxation);
      const double left = std::min(0.0, gap + travelled * speed);
      lost += 0.5 * row.damper / relaxation * (gap * gap - left * left);
    }
  }
  return work;
}

}  // namespace

EnergyLedger open_ledger(const Model& model, const ObservedState& now, bool kept) {
  EnergyLedger ledger;
  set_energies(model, now, ledger);
  ledger.initial = ledger.kinetic + ledger.elastic + ledger.gravity;
  const double own = kept ? inner_kinetic_energy(model, now.observation.kin) : ledger.kinetic;
  ledger.largest = own + ledger.elastic;
  return ledger;
}

// The step solves M (v' - v) = h (f(x) - b) + C'λ, with the mean velocity x and f(x) = f - D x - K
// (q + r x) - β K (2 x - v) + w, and moves by t u. Euler's rule: u = x = v', r = h, β = 0, M at the
// start. Midpoint rule: x = (v + v')/2, r = h/2, M in the middle, and u = x without impacts. With y
// = (v + v')/2 and all at that place,
//   T(v') - T(v) = y'MΔv = (t/h) u'MΔv + (y - (t/h) u)'MΔv,
//   (t/h) u'MΔv = t u'(f - D x) + (t/h) u'C'λ - t u'K (q + r x + β (2 x - v)) + t u'w - t u'b,
//   V(q + t u) - V(q) = t u'K q + ½ t² u'K u   of the springs.
// Their sum is works less dissipation and the integrator's own terms below, and the change of T on
// the way to that place and from there. Impacts have their own part of (y - (t/h) u)'MΔv.
void book_step(const StepInput& in, const StepPlace& place, const StepSolution& step,
               const ObservedState& next, double travelled, EnergyLedger& ledger) {
  const Model& model = in.model;
  const Kinematics& kin = place.kin;
  const double t = travelled;
  const double h = in.scene.time.step;
  const Eigen::VectorXd& u = step.qdot;
  ledger.work_tip += t * step.tip.dot(step.centre_velocity.col(in.control.tip.on(model)));
  ledger.work_active += t * step.active_torque.dot(u);
  for (const RowKind kind : row_kinds) ledger.work[kind] += t * step.force[kind].dot(u);

  double damped = 0;   // u'D x
  double stretch = 0;  // u'K (½ t u - r x - β (2 x - v))
  const double r = in.scene.time.reach();
  const double ring = in.scene.time.spring_damping();
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    damped += hinge.damping * u[k] * step.mean_velocity[k];
    stretch += hinge.stiffness * u[k] *
               (0.5 * t * u[k] - r * step.mean_velocity[k] -
                ring * (2 * step.mean_velocity[k] - in.state.qdot[k]));
  }
  const BodyVelocities before = place.motion.before();
  // The velocity v' is known to `next` at another place. Here Δv follows from x - v.
  const double whole = h / r;  // Δv over x - v
  double impulse = 0;          // (y - (t/h) u)'MΔv
  double jump = 0;             // (u - y)'MΔv
  double moved = 0;            // T(v') - T(v) at the place of the step
  double fall = 0;             // work of gravity
  double bias = 0;             // work of the inertial forces
  for (int b = 0; b < model.body_count(); ++b) {
    const PointMotion old = body_motion(before, b);
    const PointMotion by = body_motion(step.bodies(), b);
    const PointMotion dragged = body_motion(step.mean_bodies(), b);
    const PointMotion change{whole * (dragged.spin - old.spin),
                             whole * (dragged.velocity - old.velocity)};
    const PointMotion mean{old.spin + 0.5 * change.spin, old.velocity + 0.5 * change.velocity};
    const BodyMomentum gained = body_momentum(model, kin, b, change);
    moved += gained.times(mean);
    impulse += gained.times({mean.spin - t / h * by.spin, mean.velocity - t / h * by.velocity});
    jump += gained.times({by.spin - mean.spin, by.velocity - mean.velocity});
    damped += drag_power(model, kin, b, by, dragged);
    fall += t * model.bodies[b].mass * model.gravity.dot(by.velocity);
    bias += t * (step.system.bias.col(b).head<3>().dot(by.spin) +
                 step.system.bias.col(b).tail<3>().dot(by.velocity));
  }
  double pressed = 0;  // loss in flesh
  const double flesh = book_flesh(in, step, t, ledger.work, pressed) +
                       next.observation.flesh.energy - in.observation.flesh.energy;
  ledger.dissipated += t * damped;
  ledger.dissipated += pressed;
  const double kinetic = ledger.kinetic;
  const double gravity = ledger.gravity;
  set_energies(model, next, ledger);
  const double lost =
      in.scene.time.rule == TimeRule::euler ? lost_at_impacts(in, place, step) : jump;
  // `impulse` has the loss by impacts, too. It is booked as such, and the rest is the integrator's.
  ledger.impacts += lost;
  ledger.integrator_inertia += impulse + lost;
  ledger.integrator_potential += t * stretch + fall + ledger.gravity - gravity + flesh + pressed;
  ledger.integrator_coriolis += ledger.kinetic - kinetic - moved - bias;
  if (keeps_momentum(in)) {
    ledger.integrator_translation +=
        made_of_translation(in, place, step, next, t, ledger.gravity - gravity);
  }
}

}  // namespace hagfish
