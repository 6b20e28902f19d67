#include "core/chain/muscle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/chain/model.hpp"

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

}  // namespace hagfish
