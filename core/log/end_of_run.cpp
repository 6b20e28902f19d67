#include "core/log/end_of_run.hpp"

#include <cmath>

namespace hagfish {

StepRecord end_record(const Model& model, double time, const Simulation& sim, bool clamped) {
  const Eigen::VectorXd none = Eigen::VectorXd::Constant(model.nv(), NAN);
  StepRecord record;
  record.step = sim.step;
  record.time = time;
  record.after = sim.now;
  record.controller = sim.controller;
  record.controller.ends = sim.now.observation.ends;
  record.controller.rest_shape = none;
  record.controller.memory.resize(0);
  record.control.clamp_head = clamped;
  record.control.tip = {Eigen::Vector3d::Constant(NAN), NAN};
  record.control.torque.value = record.control.torque.rate = none;
  StepSolution& step = record.solution;
  step.qdot = step.next = step.active_torque = none;
  step.middle.step_velocity = step.middle.mean_velocity = none;
  for (Eigen::VectorXd& force : step.force.of_kind) force = none;
  step.tip.setConstant(NAN);
  step.stationarity = step.kkt.primal = step.kkt.complementarity = step.qp_time = NAN;
  record.ledger = sim.ledger;
  record.momentum = sim.momentum;
  record.head_drift = clamped ? head_drift(model, sim.now.observation.kin) : 0;
  return record;
}

}  // namespace hagfish
