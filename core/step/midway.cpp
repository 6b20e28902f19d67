#include "core/step/midway.hpp"

namespace hagfish {

void place_midway(const Model& model, const State& state, double h, Midway& midway) {
  advance(state.q, midway.moved, h / 2, midway.q);
  update_positions(model, midway.q, midway.kin);
  update_velocities(model, midway.moved, midway.felt, midway.kin);
  update_spline(model, midway.kin.centre, midway.segments);
  body_twists(model, midway.kin, state.qdot, midway.twist);
  centre_velocities(midway.kin, midway.twist, midway.centre_velocity);
  body_twists(model, midway.kin, midway.felt, midway.felt_twist);
}

}  // namespace hagfish
