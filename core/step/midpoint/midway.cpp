#include "core/step/midpoint/midway.hpp"

#include "core/chain/dynamics.hpp"
#include "core/contact/obstacles.hpp"

namespace hagfish {
namespace {

/// BiasPower::least over the mean momentum of the bodies over their motion. At a hundredth whips
/// keep their energy to what passes leave; at a millionth some still blow up, where a body that
/// stands for a moment is given speeds of many times its own.
constexpr double least_share = 0.01;

/// Where no body turns by more than this in a step, rad, Coriolis forces make or take some 1e-7 of
/// the kinetic energy (its third power over 12), which is not worth the price of knowing
/// it.
constexpr double least_turn = 0.01;

/// What makes the kinetic energy of each body change by the work of the forces on it alone: with
/// the velocities v and v' before and after the step and its middle m,
///   T(q', v') - T(q, v) = T_m(v') - T_m(v) + h times the power of its bias.
/// (A discrete gradient, body by body: Gonzalez, J. Nonlinear Sci. 6, 1996.)
void set_bias_power(const Model& model, const State& state, const Kinematics& now, double h,
                    Midway& midway) {
  advance(state.q, midway.step_velocity, h, midway.next.q);
  midway.next.qdot = 2 * midway.mean_velocity - state.qdot;
  kinetic_energies(model, midway.next, midway.next_energy);
  const int n = model.body_count();
  midway.bias_power.value.resize(n);
  double momentum = 0;  // over the motion, of all bodies
  for (int b = 0; b < n; ++b) {
    const Vector6d old = midway.twist.col(b);
    const Vector6d mean = midway.mean_twist.col(b);
    const Eigen::Vector3d velocity =
        point_velocity(midway.mean_twist.col(b), midway.kin.centre_offset(b));
    const BodyMomentum gained =
        body_momentum(model, midway.kin, b,
                      {2 * (mean - old).head<3>(), 2 * (velocity - midway.centre_velocity.col(b))});
    const double before =
        kinetic_energy(model, now, b, now.twist.col(b), now.centre_velocity.col(b));
    const double after = midway.next_energy[b];
    midway.bias_power.value[b] = (after - before - gained.times({mean.head<3>(), velocity})) / h;
    momentum += before + after;
  }
  midway.bias_power.least = least_share * momentum / n;
}

}  // namespace

void place_midway(const Model& model, const State& state, const Kinematics& now, double h,
                  bool balanced, Midway& midway) {
  advance(state.q, midway.step_velocity, h / 2, midway.q);
  update_positions(model, midway.q, midway.kin);
  update_velocities(model, midway.step_velocity, midway.mean_velocity, midway.kin);
  update_segments(model, midway.kin.centre, midway.segments);
  body_twists(model, midway.kin, state.qdot, midway.twist);
  centre_velocities(midway.kin, midway.twist, midway.centre_velocity);
  body_twists(model, midway.kin, midway.mean_velocity, midway.mean_twist);
  const double fastest = midway.kin.twist.topRows<3>().colwise().squaredNorm().maxCoeff();
  midway.balanced = balanced && h * h * fastest > least_turn * least_turn;
  if (midway.balanced) {
    set_bias_power(model, state, now, h, midway);
  }
}

}  // namespace hagfish
