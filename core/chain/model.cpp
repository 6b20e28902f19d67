#include "core/chain/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace hagfish {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

void set_hinge(Hinge& hinge, double limit, double stiffness, double damping) {
  hinge.lower = -limit;
  hinge.upper = limit;
  hinge.stiffness = stiffness;
  hinge.damping = damping;
}

/// Passive stiffness and damping about one kind of axis, per length: dyn cm^2, dyn cm^2 s.
struct Passive {
  double stiffness = 0, damping = 0;
};

Passive bending_at(const Specimen& specimen, const ModelSettings& settings, double fraction) {
  if (settings.passive == PassiveSource::scene) {
    return {settings.bending_stiffness, settings.bending_damping};
  }
  return {profile(specimen.station, specimen.bending_stiffness, fraction),
          profile(specimen.station, specimen.bending_damping, fraction)};
}

Passive twist_at(const Specimen& specimen, const ModelSettings& settings, double fraction) {
  if (settings.passive == PassiveSource::scene) {
    return {settings.twist_stiffness, settings.twist_damping};
  }
  return {profile(specimen.station, specimen.twist_stiffness, fraction),
          profile(specimen.station, specimen.twist_damping, fraction)};
}

}  // namespace

double Model::length() const {
  return std::accumulate(bodies.begin(), bodies.end(), 0.0,
                         [](double sum, const Body& b) { return sum + b.length; });
}

std::vector<JointName> joint_names(const Model& model) {
  const int width = model.body_count() > 100 ? 3 : 2;
  std::vector<JointName> names;
  names.push_back(
      {"root", {"root_x", "root_y", "root_z", "root_rot_x", "root_rot_y", "root_rot_z"}});
  for (int b = 1; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    const std::string number = fmt::format("j{:0{}}", b, width);
    if (body.dofs == 1 && model.hinges[body.first_dof - root_dofs].axis == Axis::x) {
      names.push_back({number + "_twist", {number + "_twist"}});
      continue;
    }
    JointName name{number + "_bend", {}};
    for (int k = 0; k < body.dofs; ++k) {
      const Axis axis = model.hinges[body.first_dof - root_dofs + k].axis;
      name.dofs.push_back(name.joint + "_" + "xyz"[static_cast<int>(axis)]);
    }
    names.push_back(std::move(name));
  }
  return names;
}

std::string dof_name(const Model& model, int dof) {
  int first = 0;
  for (const JointName& joint : joint_names(model)) {
    const int count = static_cast<int>(joint.dofs.size());
    if (dof < first + count) return joint.dofs.at(dof - first);
    first += count;
  }
  throw std::out_of_range("no velocity " + std::to_string(dof));
}

std::string cone_joint_name(const Model& model, const BendingCone& cone) {
  return joint_names(model).at(model.hinges.at(cone.dof - root_dofs).body).joint;
}

Eigen::Matrix2Xd hinge_ranges(const Model& model) {
  Eigen::Matrix2Xd ranges(2, static_cast<Eigen::Index>(model.hinges.size()));
  for (Eigen::Index k = 0; k < ranges.cols(); ++k) {
    ranges.col(k) << model.hinges[k].lower, model.hinges[k].upper;
  }
  for (const BendingCone& cone : model.cones) {
    ranges.middleCols<2>(cone.dof - root_dofs).row(0).setConstant(-cone.limit);
    ranges.middleCols<2>(cone.dof - root_dofs).row(1).setConstant(cone.limit);
  }
  return ranges;
}

Eigen::VectorXd bending_limits(const Model& model) {
  Eigen::VectorXd limits = Eigen::VectorXd::Constant(model.body_count(), unbounded);
  for (const BendingCone& cone : model.cones) {
    limits[model.hinges[cone.dof - root_dofs].body] = cone.limit;
  }
  return limits;
}

void append_body(Model& model, const Body& body, const std::vector<Axis>& axes) {
  const int index = model.body_count();
  if (index == 0 && !axes.empty()) {
    throw std::invalid_argument("body 0 hangs on the free root and takes no hinges");
  }
  model.bodies.push_back(body);
  model.bodies.back().first_dof = index == 0 ? 0 : model.nv();
  model.bodies.back().dofs = index == 0 ? root_dofs : static_cast<int>(axes.size());
  for (Axis axis : axes) model.hinges.push_back({index, axis, -unbounded, unbounded, 0, 0});
}

Eigen::Vector3d cylinder_inertia(double mass, double length, double radius) {
  const double across = mass * (3 * radius * radius + length * length) / 12;
  return {mass * radius * radius / 2, across, across};
}

namespace {

/// The nearest joint before (way -1) or after (1) joint `body` with as many hinges, body 0 none;
/// -1.
int joint_beside(const Model& model, int body, int way) {
  for (int b = body + way; b > 0 && b < model.body_count(); b += way) {
    if (model.bodies[b].dofs == model.bodies[body].dofs) return b;
  }
  return -1;
}

}  // namespace

double hinge_span(const Model& model, int body) {
  const int before = joint_beside(model, body, -1), after = joint_beside(model, body, 1);
  const double from = before < 0 ? 0 : 0.5 * (before + body);
  const double to = after < 0 ? model.body_count() : 0.5 * (body + after);
  return (to - from) * model.bodies[body].length;
}

std::vector<Obstacle> obstacles_of(const Scene& scene) {
  std::vector<Obstacle> all;
  if (scene.wall.present) all.push_back({"head plate", Plane{.neck = scene.wall.neck}});
  all.insert(all.end(), scene.obstacles.begin(), scene.obstacles.end());
  return all;
}

namespace {

/// Limits, stiffness and damping of the hinges of joint `b`.
void set_joint(const Specimen& specimen, const ModelSettings& settings, int b, Model& model) {
  const int n = model.body_count();
  const Body& body = model.bodies[b];
  const double fraction = static_cast<double>(b) / n;
  const double span = hinge_span(model, b);
  Hinge* hinge = &model.hinges[body.first_dof - root_dofs];
  if (body.dofs == 1) {
    const Passive passive = twist_at(specimen, settings, fraction);
    set_hinge(*hinge, settings.limit_scale * specimen.twist_limit / n, passive.stiffness / span,
              passive.damping / span);
    return;
  }
  const double measured = profile(specimen.station, specimen.bending_limit, fraction);
  const Passive passive = bending_at(specimen, settings, fraction);
  const int apart = settings.joints == JointLayout::universal ? 1 : 2;  // bodies
  const double limit =
      std::min(settings.limit_scale * measured * apart * body.length / specimen.bending_span,
               settings.largest_limit);
  const bool cone = settings.bending_limit == BendingLimit::cone;
  if (cone) model.cones.push_back({body.first_dof, limit});
  for (int k = 0; k < 2; ++k) {
    set_hinge(hinge[k], cone ? unbounded : limit, passive.stiffness / span, passive.damping / span);
  }
}

/// Axes of the universal joint before body b. Turns do not commute: one about Y before Z twists the
/// body by half the product of its angles, Z before Y by as much the other way. In turn these
/// twists cancel, so that one curvature makes one curve to second order in the bodies' length.
std::vector<Axis> bending_axes(JointLayout joints, int b) {
  const int before = joints == JointLayout::universal ? b - 1 : (b - 1) / 2;  // universal joints
  return before % 2 == 0 ? std::vector{Axis::z, Axis::y} : std::vector{Axis::y, Axis::z};
}

}  // namespace

Model make_hagfish(const Specimen& specimen, const Scene& scene) {
  const ModelSettings& settings = scene.model;
  const int n = settings.bodies;
  if (n < 2 || n > 400) {
    throw std::invalid_argument("model.bodies = " + std::to_string(n) + ": must be in 2..400");
  }
  const double length = specimen.length / n;
  std::vector<double> radius(n);
  std::vector<double> density(n);  // relative
  double whole = 0;
  for (int b = 0; b < n; ++b) {
    radius[b] =
        profile(specimen.station, specimen.circumference, (b + 0.5) / n) / (2 * std::numbers::pi);
    density[b] = std::pow(settings.mass_ratio, static_cast<double>(b) / (n - 1));
    whole += radius[b] * radius[b] * density[b];
  }

  Model model;
  model.obstacles = obstacles_of(scene);
  model.drag = scene.drag;
  model.gravity = scene.gravity;
  for (int b = 0; b < n; ++b) {
    const bool bend = b % 2 == 1 || settings.joints == JointLayout::universal;
    Body body;
    body.mass = specimen.mass * radius[b] * radius[b] * density[b] / whole;
    body.length = length;
    body.radius = radius[b];
    body.inertia = cylinder_inertia(body.mass, length, radius[b]);
    if (b == 0) {
      append_body(model, body, {});
    } else if (bend) {
      append_body(model, body, bending_axes(settings.joints, b));
    } else {
      append_body(model, body, {Axis::x});
    }
  }
  for (int b = 1; b < n; ++b) set_joint(specimen, settings, b, model);
  if (scene.muscle.present) model.muscles = muscles_of(specimen, model);
  return model;
}

}  // namespace hagfish
