#include "core/step/midpoint/midway.hpp"

#include "core/chain/dynamics.hpp"
#include "core/contact/obstacles.hpp"

namespace hagfish {
namespace {

/// BiasPower::least over the mean of the bodies' momenta over the motion. With a hundredth, whips
/// keep their energy up to the error of the passes. With a millionth some still blow up: a body
/// that is at rest for a moment gets speeds many times its own.
constexpr double least_share = 0.01;

/// If no body turns by more than this in a step, rad, Coriolis forces make or take about 1e-7 of
/// the kinetic energy (the third power of the angle over 12). This is not worth the cost of the
/// correction.
constexpr double least_turn = 0.01;

/// The power of each body's bias with which its kinetic energy changes by the work of the forces on
/// it alone. With the velocities v and v' before and after the step and its middle m,
///   T(q', v') - T(q, v) = T_m(v') - T_m(v) + h times the power of its bias.
/// (This is a discrete gradient, body by body: Gonzalez, J. Nonlinear Sci. 6, 1996.)
void set_bias_power(const Model& model, const State& state, const Kinematics& now, double h,
                    bool kept, Midway& midway) {
  Eigen::Vector3d observer = Eigen::Vector3d::Zero();
  Eigen::Vector3d fall = observer;  // of the observer, in the step
  if (kept) {
    observer = mean_by_mass(model, now.centre_velocity);
    fall = h * model.gravity;
  }
  advance(state.q, midway.step_velocity, h, midway.next.q);
  midway.next.qdot = 2 * midway.mean_velocity - state.qdot;
  midway.next.qdot.head<3>() -= observer + fall;
  midway.bias_power.observer = observer + 0.5 * fall;
  kinetic_energies(model, midway.next, midway.next_energy);
  const int n = model.body_count();
  midway.bias_power.value.resize(n);
  double momentum = 0;  // over the motion, of all bodies
  for (int b = 0; b < n; ++b) {
    const Vector6d old = midway.twist.col(b);
    const Vector6d mean = midway.mean_twist.col(b);
    const Eigen::Vector3d velocity =
        point_velocity(midway.mean_twist.col(b), midway.kin.centre_offset(b)) -
        midway.bias_power.observer;
    const Eigen::Vector3d first = midway.centre_velocity.col(b) - observer;
    const BodyMomentum gained =
        body_momentum(model, midway.kin, b, {2 * (mean - old).head<3>(), 2 * (velocity - first)});
    const double before =
        kinetic_energy(model, now, b, now.twist.col(b), now.centre_velocity.col(b) - observer);
    const double after = midway.next_energy[b];
    midway.bias_power.value[b] = (after - before - gained.times({mean.head<3>(), velocity})) / h;
    momentum += before + after;
  }
  midway.bias_power.least = least_share * momentum / n;
}

}  // namespace

void place_midway(const Model& model, const State& state, const Kinematics& now, double h,
                  bool balanced, bool kept, Midway& midway) {
  advance(state.q, midway.step_velocity, h / 2, midway.q);
  update_positions(model, midway.q, midway.kin);
  update_velocities(model, midway.step_velocity, midway.mean_velocity, midway.kin);
  update_segments(model, midway.kin.centre, midway.segments);
  body_twists(model, midway.kin, state.qdot, midway.twist);
  centre_velocities(midway.kin, midway.twist, midway.centre_velocity);
  body_twists(model, midway.kin, midway.mean_velocity, midway.mean_twist);
  const double fastest = midway.kin.twist.topRows<3>().colwise().squaredNorm().maxCoeff();
  midway.balanced = balanced && h * h * fastest > least_turn * least_turn;
  if (midway.balanced) set_bias_power(model, state, now, h, kept, midway);
}

}  // namespace hagfish
