#include "experiments/mechanics/rod.hpp"

#include <algorithm>
#include <cmath>

#include "core/chain/dynamics.hpp"
#include "core/control/control_law.hpp"
#include "core/knot/knot.hpp"

namespace hagfish {
namespace {

constexpr double density =
    1e-3;  // g/cm: what drag stops within a thousandth of the times that matter

/// Turns about `first` (Y or Z) and then about the other one that take `frame`'s X axis to
/// `direction`, which `frame` follows.
Eigen::Vector2d turn_to(const Eigen::Vector3d& direction, Axis first, Eigen::Quaterniond& frame) {
  const Eigen::Vector3d next = frame.conjugate() * direction;
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  Eigen::Vector2d angles;
  if (first == Axis::y) {
    angles << std::atan2(-next.z(), next.x()), std::asin(next.y());
    frame = frame * Eigen::AngleAxisd(angles[0], y) * Eigen::AngleAxisd(angles[1], z);
  } else {
    angles << std::atan2(next.y(), next.x()), std::asin(-next.z());
    frame = frame * Eigen::AngleAxisd(angles[0], z) * Eigen::AngleAxisd(angles[1], y);
  }
  return angles;
}

Scene with_loads(Scene scene, const Loads& loads) {
  if (loads) scene.controller.law = own_law;
  return scene;
}

/// Asks for the torques of the hinges that these forces are to the chain behind its clamped head.
ControlLaw pull_at(const Loads& loads) {
  return [loads](const Situation& at, Eigen::VectorXd&, Control& control) {
    const Kinematics& kin = at.now.observation.kin;
    paper_law(at, control);
    Matrix6Xd wrench = Matrix6Xd::Zero(6, at.model.body_count());
    for (const Load& load : loads(kin)) {
      const Eigen::Vector3d arm = kin.centre.col(load.body) - kin.reference;
      wrench.col(load.body) << load.moment + arm.cross(load.force), load.force;
    }
    control.torque.value = generalised_force(at.model, kin, wrench);
    control.torque.value.head<root_dofs>().setZero();
  };
}

}  // namespace

RodChain chain_of(const Rod& rod, double link, const std::vector<Eigen::Vector3d>& links,
                  double twist) {
  const bool alternating = rod.twisting > 0;
  RodChain chain;
  Body body;
  body.length = link;
  body.mass = density * link;
  body.radius = rod.radius;
  body.inertia = cylinder_inertia(body.mass, link, rod.radius);
  append_body(chain.model, body, {});
  const double span = alternating ? 2 * link : link;
  for (std::size_t b = 1; b < links.size(); ++b) {
    const bool bends = !alternating || b % 2 == 1;
    const bool z_first = rod.in_turn && (alternating ? b / 2 : b) % 2 == 1;
    append_body(chain.model, body,
                !bends    ? std::vector{Axis::x}
                : z_first ? std::vector{Axis::z, Axis::y}
                          : std::vector{Axis::y, Axis::z});
    if (bends && rod.sharpest > 0) {
      chain.model.cones.push_back({chain.model.bodies.back().first_dof, rod.sharpest * span});
    }
  }
  for (Hinge& hinge : chain.model.hinges) {
    hinge.stiffness = (hinge.axis == Axis::x ? rod.twisting : rod.bending) / span;
    if (hinge.axis != Axis::x) hinge.damping = rod.bending_damping / span;
  }
  chain.model.drag = {rod.drag, 0.1 * rod.drag};
  chain.state = rest_state(chain.model);
  Eigen::Quaterniond frame = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), links[0]);
  for (std::size_t b = 1; b < links.size(); ++b) {
    const int dof = chain.model.bodies[b].first_dof;
    if (alternating && b % 2 == 0) {
      chain.state.q[dof + 1] = twist;
      frame = frame * Eigen::AngleAxisd(twist, Eigen::Vector3d::UnitX());
      continue;
    }
    const Eigen::Vector3d way =
        alternating && b + 1 < links.size() ? links[b] + links[b + 1] : links[b];
    chain.state.q.segment<2>(dof + 1) =
        turn_to(way.normalized(), chain.model.hinges[dof - root_dofs].axis, frame);
  }
  return chain;
}

std::vector<Eigen::Vector3d> links_along(const std::vector<Eigen::Vector3d>& curve, double link) {
  std::vector<Eigen::Vector3d> links;
  Eigen::Vector3d before = curve.front();
  for (const Eigen::Vector3d& point : curve) {
    if ((point - before).norm() < link) continue;
    links.push_back((point - before).normalized());
    before = point;
  }
  return links;
}

std::vector<Eigen::Vector3d> smooth_through(const Eigen::Matrix3Xd& points, int first, int last) {
  std::vector<Eigen::Vector3d> curve;
  constexpr int samples = 50;
  for (int b = std::max(first, 1); b < std::min<int>(last, static_cast<int>(points.cols()) - 2);
       ++b) {
    const Eigen::Vector3d from = 0.5 * (points.col(b + 1) - points.col(b - 1));
    const Eigen::Vector3d to = 0.5 * (points.col(b + 2) - points.col(b));
    const Eigen::Vector3d chord = points.col(b + 1) - points.col(b);
    for (int i = 0; i < samples; ++i) {
      const double t = static_cast<double>(i) / samples;
      curve.push_back(points.col(b) +
                      t * (from + t * ((3 * chord - 2 * from - to) + t * (from + to - 2 * chord))));
    }
  }
  return curve;
}

Scene pulled_scene(double radius, double force, double step, double apart) {
  Scene scene;
  scene.wall.present = false;
  scene.contact = {.margin = radius, .least_arc = apart};
  scene.constraints.baumgarte_speed = 10 * radius;
  scene.constraints.tolerance = 0.003 * radius;
  scene.constraints.stride = radius;
  scene.script.kind = ScriptSettings::Kind::force;
  scene.script.waypoints = {{.time = 0, .value = Eigen::Vector3d(force, 0, 0)}};
  scene.time.step = step;
  scene.time.duration = 1e9;
  scene.guard.speed = 1e12;  // no time that passes here is real
  scene.guard.action = GuardAction::warn;
  scene.guard.energy_action = EnergyAction::warn;
  return scene;
}

Pulled::Pulled(RodChain chain, Scene scene, const Loads& loads)
    : chain_(std::move(chain)),
      scene_(with_loads(std::move(scene), loads)),
      sim_(start_from(chain_.model, scene_, "active-set", chain_.state, {}, 0)) {
  if (loads) sim_.law = pull_at(loads);
}

bool Pulled::relax(double still, int most_steps, double longest) {
  constexpr double shortest = 1e-9;
  constexpr int look = 20;  // steps: contacts that take turns move bodies to and fro within fewer
  const double radius = model().bodies.front().radius;
  double& h = scene_.time.step;
  Eigen::Matrix3Xd before = kin().centre;
  double time = 0;
  for (int k = 1; k <= most_steps; ++k) {
    try {
      step();
    } catch (const StepError&) {  // the QP of a long step can fail; the state is as it was
      h *= 0.3;
      if (h < shortest) throw;
      continue;
    }
    time += h;
    if (k % look == 0) {
      if ((kin().centre - before).cwiseAbs().maxCoeff() < still * time && h > 0.1 * longest)
        return true;
      before = kin().centre;
      time = 0;
    }
    const double speed = solution().centre_velocity.cwiseAbs().maxCoeff();
    h = std::min(longest, h * std::clamp(0.3 * radius / (speed * h), 0.5, 1.3));
  }
  return false;
}

std::string Pulled::knot() const {
  return knot_name(knot_type(kin().centre, {.votes = 9, .seed = 1}).type);
}

void Pulled::step() { take_step(chain_.model, scene_, sim_, record_); }

std::vector<ContactForce> Pulled::contact_forces() const {
  std::vector<ContactForce> forces;
  for (std::size_t i = 0; i < solution().rows.size(); ++i) {
    const Row& row = solution().rows[i];
    const double push = solution().lambda[static_cast<Eigen::Index>(i)];
    if (row.kind == RowKind::contact && push > 0) {
      forces.push_back(
          {row.points().a.parameter, row.points().b.parameter, push / scene_.time.step});
    }
  }
  return forces;
}

double Pulled::twisting_moment() const {
  double sum = 0;
  int joints = 0;
  for (std::size_t k = 0; k < model().hinges.size(); ++k) {
    const Hinge& hinge = model().hinges[k];
    if (hinge.axis != Axis::x) continue;
    sum += hinge.stiffness * sim_.now.state.q[static_cast<Eigen::Index>(k) + root_dofs + 1];
    ++joints;
  }
  return sum / joints;
}

double Pulled::press() const {
  double sum = 0;
  for (std::size_t i = 0; i < solution().rows.size(); ++i) {
    if (solution().rows[i].kind != RowKind::obstacle) continue;
    sum += solution().lambda[static_cast<Eigen::Index>(i)] / scene_.time.step;
  }
  return sum;
}

Eigen::Vector3d Pulled::force_behind(int body) const {
  Eigen::Vector3d force = solution().tip;
  for (std::size_t i = 0; i < solution().rows.size(); ++i) {
    if (solution().rows[i].kind != RowKind::contact) continue;
    const double push = solution().lambda[static_cast<Eigen::Index>(i)] / scene_.time.step;
    visit_forces(solution().rows[i], kin(),
                 [&](int b, const Eigen::Vector3d&, const Eigen::Vector3d& unit) {
                   if (b >= body) force += push * unit;
                 });
  }
  return force;
}

double Pulled::mean_curvature(double from, double to) const {
  double turned = 0;
  const auto joints = std::ranges::count(model().bodies, 2, &Body::dofs);
  const double half = 0.5 * (model().body_count() - 1) / static_cast<double>(joints);
  for (int b = 1; b < model().body_count(); ++b) {
    if (model().bodies[b].dofs != 2) continue;
    const double joint = b - 0.5;
    const double share = std::min(joint + half, to) - std::max(joint - half, from);
    if (share <= 0) continue;
    const Eigen::Vector3d before = kin().rotation[b - 1].col(0);
    const Eigen::Vector3d after = kin().rotation[b].col(0);
    turned += share / (2 * half) * std::atan2(before.cross(after).norm(), before.dot(after));
  }
  return turned / (to - from) / model().bodies.front().length;
}

}  // namespace hagfish
