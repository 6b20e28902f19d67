#include "mujoco_ref/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/chain/dynamics.hpp"
#include "core/input/input_error.hpp"
#include "core/muscle/active_curvature.hpp"
#include "mujoco_ref/mirror.hpp"

namespace hagfish {
namespace {

MujocoModel made(const Model& model, const Scene& scene, const MujocoSettings& settings,
                 Head head) {
  MujocoModel mirror(mjcf_files(model, scene.contact.least_arc, scene.time.step, head));
  mjModel& m = *mirror.model();
  m.opt.solver = mjSOL_NEWTON;
  m.opt.jacobian = mjJAC_DENSE;
  m.opt.integrator = settings.integrator == MujocoIntegrator::euler      ? mjINT_EULER
                     : settings.integrator == MujocoIntegrator::implicit ? mjINT_IMPLICIT
                                                                         : mjINT_RK4;
  const auto soften = [&settings](mjtNum* solref, int count) {
    for (int i = 0; i < count; ++i) {
      solref[mjNREF * i] = settings.contact_time;
      solref[mjNREF * i + 1] = 1;
    }
  };
  soften(m.geom_solref, m.ngeom);
  soften(m.jnt_solref, m.njnt);
  return mirror;
}

/// Where along the body `point` (cm, world) of body `b` is, as a spline parameter, counted in
/// bodies between the middles of the first and the last one.
double parameter_of(const Model& model, const Kinematics& kin, int b,
                    const Eigen::Vector3d& point) {
  const double along = (point - kin.centre.col(b)).dot(kin.rotation[b].col(0));
  const double last = model.body_count() - 1;
  return std::clamp(b + along / model.bodies[b].length, 0.0, last);
}

/// A spline point of that parameter.
SplineMix mix_at(const Model& model, double parameter) {
  const int segment = std::min(static_cast<int>(parameter), model.body_count() - 2);
  return spline_mix(segment, parameter - segment, model.body_count());
}

}  // namespace

MujocoLoop::MujocoLoop(const Model& model, const Scene& scene, const MujocoSettings& settings)
    : model_(model), scene_(scene), settings_(settings) {
  if (scene.wall.present)
    throw InputError("wall.present: must be false, since MuJoCo's model has no head plate");
  if (scene.flesh.present()) throw InputError("flesh.stiffness: a run in MuJoCo has hard contact");
  if (!scene.obstacles.empty()) throw InputError("obstacle: a run in MuJoCo cannot have obstacles");
  using Kind = ScriptSettings::Kind;
  if (scene.script.kind == Kind::force || scene.script.kind == Kind::position) {
    throw InputError(
        "script.kind: no script can pull the tail in MuJoCo; it must be \"curvature\" or "
        "\"none\"");
  }
  if (scene.time.rule != TimeRule::euler) {
    throw InputError("time.rule: must be \"euler\" for a run in MuJoCo");
  }
}

/// Energies and momentum are those of `next`; of works MuJoCo tells no more than `work` (erg),
/// which the muscles have done in the step.
void MujocoLoop::book(double work, const ObservedState& next, Simulation& sim) const {
  const EnergyLedger before = sim.ledger;
  sim.ledger =
      open_ledger(model_, next, keeps_momentum(scene_, clamps_head(scene_, sim.controller.phase)));
  sim.ledger.initial = before.initial;
  sim.ledger.work_active = before.work_active + work;
  sim.ledger.work.of_kind.fill(NAN);
  sim.ledger.dissipated = sim.ledger.integrator_inertia = NAN;
  const Momentum initial = sim.momentum.initial;
  sim.momentum = open_momentum(model_, next);
  sim.momentum.initial = initial;
  for (Momentum* impulse : {&sim.momentum.drag, &sim.momentum.outside, &sim.momentum.integrator,
                            &sim.momentum.given_back}) {
    impulse->linear.setConstant(NAN);
    impulse->angular.setConstant(NAN);
  }
}

MujocoModel& MujocoLoop::mirror(Head head) {
  std::optional<MujocoModel>& mirror = head == Head::clamped ? clamped_ : free_;
  if (!mirror) mirror.emplace(made(model_, scene_, settings_, head));
  return *mirror;
}

/// Dampers, springs at the step's end and the muscles' share by velocity, which Euler's rule and
/// the implicit one take implicitly; by RK4 all is explicit.
bool MujocoLoop::damps_implicitly() const { return settings_.integrator != MujocoIntegrator::rk4; }

void MujocoLoop::apply(const Simulation& sim, const Control& control, MujocoModel& mirror,
                       ActiveTorque& muscles) const {
  const Eigen::VectorXd& qdot = sim.now.state.qdot;
  muscles.value.setZero(model_.nv());
  muscles.rate.setZero(model_.nv());
  for (const ActiveTorque* asked : {&control.active, &control.torque}) {
    if (asked->value.size() == 0) continue;
    muscles.value += asked->value;
    muscles.rate += asked->rate;
  }
  Eigen::VectorXd force = muscles.value + drag_force(model_, sim.now.observation.kin, qdot);
  mjModel& m = *mirror.model();
  const Eigen::Index root = model_.nv() - m.nv;  // velocities that a clamped head has not
  if (damps_implicitly()) {
    for (Eigen::Index k = root_dofs; k < model_.nv(); ++k) {
      const Hinge& hinge = model_.hinges[k - root_dofs];
      m.dof_damping[k - root] = hinge.damping + m.opt.timestep * hinge.stiffness + muscles.rate[k];
    }
  } else {
    force -= muscles.rate.cwiseProduct(qdot);
  }
  mju_copy(mirror.data()->qfrc_applied, force.data() + root, m.nv);
}

void MujocoLoop::note_forces(const Simulation& sim, MujocoModel& mirror, StepSolution& step) const {
  const mjModel& m = *mirror.model();
  mjData& d = *mirror.data();
  const double h = scene_.time.step;
  const Eigen::Index root = model_.nv() - m.nv;  // velocities that a clamped head has not
  for (const RowKind kind : row_kinds) step.force[kind].setZero(model_.nv());
  if (root > 0) step.force[RowKind::head].head<root_dofs>().setConstant(NAN);
  step.rows.clear();
  std::vector<double> lambda;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(m.nv);  // as it stays where there are no rows
  Eigen::VectorXd of_rows(std::max(d.nefc, 1));
  for (const auto& [kind, type] : {std::pair(RowKind::limit, mjCNSTR_LIMIT_JOINT),
                                   std::pair(RowKind::contact, mjCNSTR_CONTACT_FRICTIONLESS)}) {
    for (int i = 0; i < d.nefc; ++i) of_rows[i] = d.efc_type[i] == type ? d.efc_force[i] : 0;
    mj_mulJacTVec(&m, &d, force.data(), of_rows.data());
    step.force[kind].tail(m.nv) = force;
  }
  for (int c = 0; c < d.ncon; ++c) {
    const mjContact& contact = d.contact[c];
    if (contact.efc_address < 0) continue;
    const Kinematics& kin = sim.now.observation.kin;
    const Eigen::Vector3d point = Eigen::Vector3d::Map(contact.pos);
    // MuJoCo's body 0 is the world; its normal points from the first geom, nearer the head, to the
    // second.
    const int a = m.geom_bodyid[contact.geom1] - 1;
    const int b = m.geom_bodyid[contact.geom2] - 1;
    Row row;
    row.kind = RowKind::contact;
    const auto mix = [&](int body) {
      return mix_at(model_, parameter_of(model_, kin, body, point));
    };
    const Eigen::Vector3d normal = Eigen::Vector3d::Map(contact.frame);
    row.shape = a > b ? BetweenPoints{normal, mix(b), mix(a), {}, {}}
                      : BetweenPoints{-normal, mix(a), mix(b), {}, {}};
    step.rows.push_back(row);
    lambda.push_back(h * d.efc_force[contact.efc_address]);
  }
  step.lambda = Eigen::VectorXd::Map(lambda.data(), static_cast<Eigen::Index>(lambda.size()));
  step.excess.setConstant(step.lambda.size(), NAN);
  step.active = static_cast<int>((step.lambda.array() != 0).count());
  step.iterations = d.solver_iter;
  step.net_force.setConstant(model_.nv(), NAN);
  step.tip.setZero();
  step.stationarity = step.kkt.primal = step.kkt.complementarity = step.qp_time = NAN;
}

void MujocoLoop::take_step(Simulation& sim, StepRecord& record) {
  const double h = scene_.time.step;
  StepSolution& step = record.solution;
  record.step = sim.step;
  record.time = time_of(sim, scene_);
  record.warnings.clear();
  if (Status status = decide(model_, scene_, sim.now, record.time, sim.named_law, sim.controller,
                             record.control, sim.law);
      !status.ok()) {
    throw StepError(status);
  }
  record.controller = sim.controller;
  if (!record.control.thigmotaxis.empty()) {
    throw StepError({Outcome::solver_failed,
                     "the control law asks for rows of Eq. 6, which MuJoCo does not have"});
  }
  MujocoModel& mirror = this->mirror(record.control.clamp_head ? Head::clamped : Head::free);
  set_state(model_, sim.now.state, mirror);
  apply(sim, record.control, mirror, muscles_);
  mj_step(mirror.model(), mirror.data());
  check_stable(mirror);
  note_forces(sim, mirror, step);
  ObservedState& next = record.after;
  next.state = state_of(model_, mirror);
  step.qdot = step.next = step.mean_velocity = next.state.qdot;
  const Eigen::VectorXd& acts_at = damps_implicitly() ? step.next : sim.now.state.qdot;
  step.active_torque = muscles_.value - muscles_.rate.cwiseProduct(acts_at);
  observe(model_, next.state, scene_, sim.search, next.observation);
  if (Status status = guard_state(model_, next, 0, scene_, sim.watch, record.warnings);
      !status.ok()) {
    throw StepError(status);
  }
  record.ledger = sim.ledger;
  record.momentum = sim.momentum;
  book(h * step.active_torque.dot(step.qdot), next, sim);
  record.head_drift = 0;
  record.crossing = 0;
  std::swap(sim.now, next);
  ++sim.step;
}

}  // namespace hagfish
