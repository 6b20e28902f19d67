#include "core/run/momentum.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace hagfish {
namespace {

/// The sum over all bodies of `of(body)`, a moment and a force, or angular and linear momentum, at
/// each body's centre; moments about `centre` (cm, world).
template <class Of>
Momentum sum_over_bodies(const Model& model, const Kinematics& kin, const Eigen::Vector3d& centre,
                         Of of) {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = linear;
  for (int b = 0; b < model.body_count(); ++b) {
    const auto [own, force] = of(b);
    angular += own + (kin.centre.col(b) - centre).cross(force);
    linear += force;
  }
  return {linear, angular};
}

/// Drag and outside forces over the step `in`, with moments about `centre`.
struct Impulses {
  Momentum drag, outside;
};

Impulses impulses_of(const StepInput& in, const Kinematics& kin, const StepSolution& step,
                     const Eigen::Vector3d& centre) {
  const Model& model = in.model;
  const double h = in.scene.time.step;
  const Momentum drag = sum_over_bodies(model, kin, centre, [&](int b) {
    return drag_on_body(model, kin, b, body_motion(step.mean_bodies(), b));
  });
  Momentum outside;
  outside.linear = model.mass() * model.gravity + step.tip;
  outside.angular = (kin.centre.col(in.control.tip.on(model)) - centre).cross(step.tip);
  for (const RowKind kind : row_kinds) {
    if (!from_outside(kind)) continue;
    outside.linear += step.force[kind].head<3>();
    outside.angular += moment_of_root(step.force[kind], kin, centre);
  }
  return {drag * h, outside * h};
}

/// The gain of the step by the root's rows of Eq. 1, with moments about `centre`: Σ m (v' - v) + h
/// Σ bias, with the velocities v, v' of the bodies' centres before and after, at the positions of
/// the step's equations. Forces between two parts of the body, of joints and of muscles cancel.
Momentum gained(const StepInput& in, const StepPlace& place, const StepSolution& step,
                const Eigen::Vector3d& centre) {
  const double h = in.scene.time.step;
  const BodyVelocities mean = step.mean_bodies(), before = place.motion.before();
  const double whole = h / in.scene.time.reach();  // v' - v over its part in the mean velocity
  return sum_over_bodies(in.model, place.kin, centre, [&](int b) {
    const auto [angular, linear] =
        body_momentum(in.model, place.kin, b,
                      {whole * (mean.twist.col(b) - before.twist.col(b)).head<3>(),
                       whole * (mean.centre.col(b) - before.centre.col(b))});
    return CentreWrench{angular + h * step.system.bias.col(b).head<3>(),
                        linear + h * step.system.bias.col(b).tail<3>()};
  });
}

/// Inertia of all bodies with locked joints, about their centre of mass, world axes, g cm².
Eigen::Matrix3d locked_inertia(const Model& model, const Kinematics& kin,
                               const Eigen::Vector3d& centre) {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    const Eigen::Vector3d arm = kin.centre.col(b) - centre;
    const Eigen::Matrix3d& axes = kin.rotation[b];
    inertia +=
        axes * body.inertia.asDiagonal() * axes.transpose() - body.mass * arm * arm.transpose();
    inertia.diagonal().array() += body.mass * arm.squaredNorm();
  }
  return inertia;
}

/// Share of its energy about the centre of mass that a body may gain when a step gives its momentum
/// back, beyond what its internal motion has. More is not given. The most seen is 0.013: by Euler's
/// rule, in steps of 5 ms, as a knot comes off.
constexpr double most_added = 0.02;
/// Internal motion with a smaller share of the energy is rounding.
constexpr double rounding = 1e-12;

/// Gives `next`, which has the momentum `now` and the kinetic energy `kinetic` (erg), the momentum
/// `wanted`, by a motion of the whole body as one rigid body about its centre of mass. The kinetic
/// energy about that centre stays the same: one factor on the internal velocities takes up the
/// difference. If no factor can, it grows by a share of up to most_added. Else the body keeps its
/// angular momentum, and the guard of momentum warns.
void give(const Model& model, double kinetic, const Momentum& now, const Momentum& wanted,
          ObservedState& next) {
  Kinematics& kin = next.observation.kin;
  const Eigen::Vector3d centre = centre_of_mass(model, kin);
  const auto inertia = locked_inertia(model, kin, centre).llt();
  const double mass = model.mass();
  const Eigen::Vector3d old_turn = inertia.solve(now.angular);
  Eigen::Vector3d turn = inertia.solve(wanted.angular);
  const double whole = inner_kinetic_energy(model, kin);
  const double inner = whole - 0.5 * now.angular.dot(old_turn);
  double left = whole - 0.5 * wanted.angular.dot(turn);
  if (left < -most_added * whole - rounding * kinetic) {
    turn = old_turn;
    left = inner;
  }
  const double factor = inner > rounding * kinetic && left > 0 ? std::sqrt(left / inner) : 1;
  const Eigen::Vector3d arm = kin.origin.col(0) - centre;
  Eigen::VectorXd& v = next.state.qdot;
  const Eigen::Vector3d linear = v.head<3>() - now.linear / mass - old_turn.cross(arm);
  const Eigen::Vector3d spin = kin.rotation[0] * v.segment<3>(3) - old_turn;
  v *= factor;
  v.head<3>() = factor * linear + wanted.linear / mass + turn.cross(arm);
  v.segment<3>(3) = kin.rotation[0].transpose() * (factor * spin + turn);
  update_velocities(model, v, kin);
}

}  // namespace

Momentum& Momentum::operator+=(const Momentum& more) {
  linear += more.linear;
  angular += more.angular;
  return *this;
}

Momentum& Momentum::operator-=(const Momentum& less) {
  linear -= less.linear;
  angular -= less.angular;
  return *this;
}

Eigen::Vector3d moment_of_root(const Eigen::VectorXd& force, const Kinematics& kin,
                               const Eigen::Vector3d& centre) {
  const Eigen::Vector3d sum = force.head<3>();
  return kin.rotation[0] * force.segment<3>(3) + (kin.origin.col(0) - centre).cross(sum);
}

Momentum momentum_of(const Model& model, const Kinematics& kin) {
  return sum_over_bodies(model, kin, centre_of_mass(model, kin), [&](int b) {
    return body_momentum(model, kin, b, body_motion(kin.velocities(), b));
  });
}

double passing_momentum(const StepInput& in, const StepSolution& step) {
  double force = in.model.mass() * in.model.gravity.norm() + step.tip.norm();
  for (const RowKind kind : row_kinds) {
    if (from_outside(kind)) force += step.force[kind].head<3>().norm();
  }
  double sum = in.scene.time.step * force;
  for (int b = 0; b < in.model.body_count(); ++b) {
    sum += in.model.bodies[b].mass * in.observation.kin.centre_velocity.col(b).norm();
  }
  return sum;
}

MomentumLedger open_momentum(const Model& model, const ObservedState& now) {
  MomentumLedger ledger;
  ledger.initial = momentum_of(model, now.observation.kin);
  ledger.momentum = ledger.initial;
  return ledger;
}

Eigen::Vector3d centre_after(const StepInput& in, const StepPlace& place, const StepSolution& step,
                             const Momentum& before, double travelled) {
  // M (w - v) + r b = r f + C'λ, with the velocity w that the step moves by and its reach r.
  const Model& model = in.model;
  const Eigen::Matrix3Xd& old = place.motion.centre_velocity;
  Eigen::Vector3d momentum = before.linear;
  for (int b = 0; b < model.body_count(); ++b) {
    momentum += model.bodies[b].mass * (step.centre_velocity.col(b) - old.col(b)) +
                in.scene.time.reach() * step.system.bias.col(b).tail<3>();
  }
  return centre_of_mass(model, in.observation.kin) + travelled / model.mass() * momentum;
}

void book_momentum(const StepInput& in, const StepPlace& place, const StepSolution& step,
                   ObservedState& next, EnergyLedger& energy, MomentumLedger& ledger) {
  const Model& model = in.model;
  const Kinematics& kin = next.observation.kin;
  const Eigen::Vector3d middle = centre_of_mass(model, place.kin);
  const auto [drag, outside] = impulses_of(in, place.kin, step, middle);
  const Momentum old = ledger.momentum;
  ledger.momentum = momentum_of(model, kin);
  ledger.integrator += ledger.momentum - old - gained(in, place, step, middle);
  ledger.drag += drag;
  ledger.outside += outside;
  const Momentum before = ledger.momentum;
  if (keeps_momentum(in)) {
    give(model, energy.kinetic, before, old + drag + outside, next);
    ledger.momentum = momentum_of(model, kin);
    ledger.given_back += ledger.momentum - before;
    const double kinetic = kinetic_energy(model, kin);
    energy.integrator_momentum += kinetic - energy.kinetic;
    const Eigen::Vector3d given = ledger.momentum.linear - before.linear;
    energy.integrator_translation +=
        0.5 * given.dot(ledger.momentum.linear + before.linear) / model.mass();
    energy.kinetic = kinetic;
  }
}

}  // namespace hagfish
