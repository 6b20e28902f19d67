#include "core/chain/muscle_paths.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace hagfish {
namespace {

/// Oblique lines of one family, evenly around the body, so that they do not bend it.
constexpr int oblique_lines = 4;
/// Most that an oblique line turns about the body's axis from one end to the other, rad: its chord
/// stays near the surface in chains of few bodies too.
constexpr double most_turn = 1;

Eigen::Vector3d on_surface(double along, double radius, double angle) {
  return {along, radius * std::cos(angle), radius * std::sin(angle)};
}

/// From the front end of the body before the joint to the rear end of the one behind it, at
/// `angle` about the body's axis from +y: lines of one bending joint go on in those of the next.
Muscle longitudinal(const Model& model, int body, double share, double angle) {
  const Body& head = model.bodies[body - 1];
  const Body& tail = model.bodies[body];
  return {{},
          body,
          0,
          {{on_surface(0, share * head.radius, angle),
            on_surface(tail.length, share * tail.radius, angle)}}};
}

/// Fibres at `slope` (rad) to the body's axis, negative: wound the other way.
Muscle oblique(const Model& model, int body, double share, double slope) {
  const Body& head = model.bodies[body - 1];
  const Body& tail = model.bodies[body];
  const double radius = share * 0.5 * (head.radius + tail.radius);
  const double reach = std::min(0.5 * std::min(head.length, tail.length),
                                0.5 * most_turn * radius / std::abs(std::tan(slope)));
  const double turn = 2 * reach * std::tan(slope) / radius;
  Muscle muscle{{}, body, 0, {}};
  for (int k = 0; k < oblique_lines; ++k) {
    const double angle = 2 * std::numbers::pi * k / oblique_lines;
    muscle.lines.push_back({on_surface(head.length - reach, radius, angle - 0.5 * turn),
                            on_surface(reach, radius, angle + 0.5 * turn)});
  }
  return muscle;
}

struct LineEnds {
  Eigen::Vector3d head, tail;  // world, cm
};

LineEnds ends_of(const Kinematics& kin, const Muscle& muscle, const MuscleLine& line) {
  const auto place = [&kin](int body, const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return kin.origin.col(body) + kin.rotation[body] * point;
  };
  return {place(muscle.body - 1, line.head), place(muscle.body, line.tail)};
}

}  // namespace

std::vector<Muscle> muscles_of(const Specimen& specimen, const Model& model) {
  const MuscleTissue& tissue = specimen.muscle;
  const std::vector<JointName> names = joint_names(model);
  std::vector<Muscle> muscles;
  for (int b = 1; b < model.body_count(); ++b) {
    const double fraction = static_cast<double>(b) / model.body_count();
    const auto add = [&](const char* name, Muscle muscle, const std::vector<double>& area) {
      muscle.name = names[b].joint.substr(0, names[b].joint.find('_')) + '_' + name;
      muscle.force = profile(specimen.station, area, fraction) * tissue.stress /
                     static_cast<double>(muscle.lines.size());
      muscles.push_back(std::move(muscle));
    };
    if (model.bodies[b].dofs == 2) {
      const auto line = [&](const char* name, double quarters) {
        add(name, longitudinal(model, b, tissue.radius_share, quarters * std::numbers::pi / 2),
            tissue.longitudinal_area);
      };
      line("left", 2);
      line("right", 0);
      line("dorsal", 1);
      line("ventral", 3);
    } else {
      for (const auto& [name, sense] : {std::pair("right_handed", 1), {"left_handed", -1}}) {
        add(name, oblique(model, b, tissue.radius_share, sense * tissue.oblique_angle),
            tissue.oblique_area);
      }
    }
  }
  return muscles;
}

MuscleGroup muscle_group(const Model& model, int first) {
  MuscleGroup group{first, 0};
  const int all = static_cast<int>(model.muscles.size());
  while (first + group.count < all &&
         model.muscles[first + group.count].body == model.muscles[first].body) {
    ++group.count;
  }
  return group;
}

double muscle_length(const Kinematics& kin, const Muscle& muscle) {
  double length = 0;
  for (const MuscleLine& line : muscle.lines) {
    const LineEnds ends = ends_of(kin, muscle, line);
    length += (ends.tail - ends.head).norm();
  }
  return length;
}

void moment_arms(const Model& model, const Kinematics& kin, const Muscle& muscle,
                 Eigen::Ref<Eigen::VectorXd> arm) {
  const Body& body = model.bodies[muscle.body];
  arm.setZero();
  for (const MuscleLine& line : muscle.lines) {
    const LineEnds ends = ends_of(kin, muscle, line);
    const Eigen::Vector3d pull = (ends.tail - ends.head).stableNormalized();
    const Eigen::Vector3d offset = ends.tail - kin.reference;
    for (int k = 0; k < body.dofs; ++k) {
      const Vector6d axis = kin.axis.col(body.first_dof + k);
      arm[k] -= pull.dot(axis.tail<3>() + axis.head<3>().cross(offset));
    }
  }
}

void muscle_torque(const Model& model, const Kinematics& kin,
                   const Eigen::Ref<const Eigen::VectorXd>& activation, Eigen::VectorXd& torque) {
  torque.setZero(model.nv());
  Eigen::Vector3d arm;  // a joint has three hinges at most
  for (std::size_t m = 0; m < model.muscles.size(); ++m) {
    const Muscle& muscle = model.muscles[m];
    const Body& body = model.bodies[muscle.body];
    moment_arms(model, kin, muscle, arm.head(body.dofs));
    torque.segment(body.first_dof, body.dofs) +=
        activation[static_cast<Eigen::Index>(m)] * muscle.force * arm.head(body.dofs);
  }
}

}  // namespace hagfish
