#include "core/chain/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/chain/bending.hpp"

namespace hagfish {
namespace {

/// Passive stiffness and damping about one kind of axis, per length: dyn cm^2, dyn cm^2 s.
struct Passive {
  double stiffness = 0, damping = 0;
};

/// `uniform` all along the body, or the specimen's profiles of both at `fraction` of its length.
Passive passive_at(const Specimen& specimen, PassiveSource source, const Passive& uniform,
                   const std::vector<double>& stiffness, const std::vector<double>& damping,
                   double fraction) {
  if (source == PassiveSource::scene) return uniform;
  return {profile(specimen.station, stiffness, fraction),
          profile(specimen.station, damping, fraction)};
}

/// The nearest joint before (way -1) or after (way 1) joint `body` that has as many hinges; -1 if
/// there is none. Body 0 has no joint.
int joint_beside(const Model& model, int body, int way) {
  for (int b = body + way; b > 0 && b < model.body_count(); b += way) {
    if (model.bodies[b].dofs == model.bodies[body].dofs) return b;
  }
  return -1;
}

/// Largest angle of joint `b` to either side, of its twist or of each bend, rad.
double joint_limit(const Specimen& specimen, const ModelSettings& settings, const Model& model,
                   int b) {
  const int n = model.body_count();
  if (!bends(model.bodies[b])) return settings.limit_scale * specimen.twist_limit / n;
  const double measured =
      profile(specimen.station, specimen.bending_limit, static_cast<double>(b) / n);
  const int apart = settings.joints == JointLayout::universal ? 1 : 2;  // bodies
  return std::min(
      settings.limit_scale * measured * apart * model.bodies[b].length / specimen.bending_span,
      settings.largest_limit);
}

/// Sets limits, stiffness and damping of the hinges of joint `b`.
void set_joint(const Specimen& specimen, const ModelSettings& settings, int b, Model& model) {
  const Body& body = model.bodies[b];
  const double fraction = static_cast<double>(b) / model.body_count();
  const double span = hinge_span(model, b);
  const Passive passive =
      bends(body) ? passive_at(specimen, settings.passive,
                               {settings.bending_stiffness, settings.bending_damping},
                               specimen.bending_stiffness, specimen.bending_damping, fraction)
                  : passive_at(specimen, settings.passive,
                               {settings.twist_stiffness, settings.twist_damping},
                               specimen.twist_stiffness, specimen.twist_damping, fraction);
  const double limit = joint_limit(specimen, settings, model, b);
  const bool cone = bends(body) && settings.bending_limit == BendingLimit::cone;
  if (cone) model.cones.push_back({body.first_dof, limit});
  for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
    Hinge& hinge = model.hinges[k - root_dofs];
    hinge.upper = cone ? INFINITY : limit;
    hinge.lower = -hinge.upper;
    hinge.stiffness = passive.stiffness / span;
    hinge.damping = passive.damping / span;
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

double Model::length() const {
  double sum = 0;
  for (const Body& body : bodies) sum += body.length;
  return sum;
}

double Model::mass() const {
  double sum = 0;
  for (const Body& body : bodies) sum += body.mass;
  return sum;
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

std::vector<std::string> coordinate_names(const Model& model) {
  std::vector<std::string> names{"root_x",  "root_y",  "root_z", "root_qw",
                                 "root_qx", "root_qy", "root_qz"};
  for (const JointName& joint : joint_names(model)) {
    if (joint.joint != "root") names.insert(names.end(), joint.dofs.begin(), joint.dofs.end());
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
  Eigen::Matrix2Xd ranges(2, model.hinge_count());
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
  Eigen::VectorXd limits = Eigen::VectorXd::Constant(model.body_count(), INFINITY);
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
  for (Axis axis : axes) model.hinges.push_back({index, axis, -INFINITY, INFINITY, 0, 0});
}

Eigen::Vector3d cylinder_inertia(double mass, double length, double radius) {
  const double across = mass * (3 * radius * radius + length * length) / 12;
  return {mass * radius * radius / 2, across, across};
}

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
