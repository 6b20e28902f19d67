#include "core/step/midway.hpp"

namespace hagfish {

void place_midway(const Model& model, const State& state, const Eigen::VectorXd& moved, double h,
                  Midway& midway) {
  advance(state.q, moved, h / 2, midway.q);
  update_positions(model, midway.q, midway.kin);
  update_velocities(model, moved, midway.kin);
  update_spline(model, midway.kin.centre, midway.segments);
  body_twists(model, midway.kin, state.qdot, midway.twist);
  centre_velocities(midway.kin, midway.twist, midway.centre_velocity);
}

}  // namespace hagfish
