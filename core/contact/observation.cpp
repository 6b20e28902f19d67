#include "core/contact/observation.hpp"

#include <algorithm>

#include "core/chain/bending.hpp"
#include "core/contact/obstacles.hpp"

namespace hagfish {
namespace {

/// Pairs of segments that are not a minimum of the gap are listed if they could close it in a step
/// at this share of the speed at which overlapping strands are pushed apart. Beside a minimum
/// strands close more slowly than at it.
constexpr double closing_speed = 0.2;

}  // namespace

void observe(const Model& model, const State& state, const Scene& scene, ContactSearch& search,
             Observation& observation) {
  update_positions(model, state.q, observation.kin);
  observe_placed(model, state, scene, search, observation);
}

void observe_placed(const Model& model, const State& state, const Scene& scene,
                    ContactSearch& search, Observation& observation) {
  Observation& o = observation;
  update_velocities(model, state.qdot, o.kin);
  update_segments(model, o.kin.centre, o.segments);
  const double near = closing_speed * scene.constraints.baumgarte_speed * scene.time.step;
  find_contacts(o.segments, scene.contact, near, search, o.contact);
  o.ends = touching_ends(o.segments, o.contact.contacts, scene, o.patches);
  find_flesh(model, scene, o.kin, o.segments, o.contact, o.flesh);
  o.penetration = std::max(0.0, -o.contact.least_gap);
  visit_plane_gaps(model, o.kin,
                   [&](const PlaneGap& at) { o.penetration = std::max(o.penetration, -at.gap); });
  double past_limit = 0;
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    past_limit =
        std::max(past_limit, std::max(hinge.lower - state.q[k + 1], state.q[k + 1] - hinge.upper));
  }
  for (const BendingCone& cone : model.cones) {
    past_limit = std::max(past_limit, past_cone(cone, state.q));
  }
  o.limit_violation = past_limit;
}

Observation observe(const Model& model, const State& state, const Scene& scene) {
  ContactSearch search;
  Observation observation;
  observe(model, state, scene, search, observation);
  return observation;
}

double head_drift(const Model& model, const Kinematics& kin) {
  const Eigen::Vector3d origin = kin.origin.col(0);
  const Body& head = model.bodies[0];
  const Eigen::Matrix3d turn = kin.rotation[0] - Eigen::Matrix3d::Identity();
  return std::max({origin.norm(), (origin + head.length * turn.col(0)).norm(),
                   (origin + head.radius * turn.col(1)).norm()});
}

}  // namespace hagfish
