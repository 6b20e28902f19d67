#include "core/log/log_header.hpp"

#include <fmt/chrono.h>

#include <chrono>
#include <cmath>

#include "core/knot/knot.hpp"
#include "core/log/axis_labels.hpp"
#include "core/log/build_info.hpp"
#include "core/log/coordinate_names.hpp"
#include "core/log/ledger_columns.hpp"
#include "core/scene/phase.hpp"
#include "core/step/rows/row_kind.hpp"

namespace hagfish {
namespace {

std::string current_time() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

}  // namespace

void write_header(const LogHeader& header, Hdf5Writer& h5) {
  h5.root_attribute("format", log_format);
  h5.root_attribute("format_version", log_format_version);
  h5.root_attribute("creator", "hagfish");
  h5.root_attribute("creator_version", build_version());
  h5.root_attribute("git_revision", build_revision());
  h5.root_attribute("created", current_time());
  h5.root_attribute("command", header.command);
  h5.root_attribute("log_level", log_level_name(header.level));
  h5.root_attribute("scene", header.scene);
  h5.root_attribute("qp", header.qp);
  h5.root_attribute("libraries", header.libraries);
  h5.root_attribute("compiler", build_compiler());
  h5.root_attribute("cpu", cpu_name());
  h5.root_attribute("status", "running");
  h5.root_attribute("warnings", "");
  if (!header.simulator.empty()) h5.root_attribute("simulator", header.simulator);
  if (!header.branched_from.empty()) h5.root_attribute("branched_from", header.branched_from);
  if (!header.past.empty()) {
    std::vector<std::string> scenes;
    Eigen::VectorXd ends(static_cast<Eigen::Index>(header.past.size()));
    for (const SceneBefore& before : header.past) {
      ends[static_cast<Eigen::Index>(scenes.size())] = static_cast<double>(before.end);
      scenes.push_back(before.scene);
    }
    h5.group("/branch");
    h5.texts(past_scenes, scenes);
    h5.numbers(past_ends, ends, {"1", "step before which each scene gave way to the next one"});
  }
  h5.group("/mjcf");
  if (header.level == LogLevel::summary) return;  // without q there is nothing to replay
  for (const auto& [name, text] : header.mjcf) h5.text("/mjcf/" + name, text);
}

Eigen::VectorXd body_arcs(const Model& model) {
  Eigen::VectorXd arc(model.body_count());
  double end = 0;
  for (int b = 0; b < model.body_count(); ++b) {
    arc[b] = end + 0.5 * model.bodies[b].length;
    end += model.bodies[b].length;
  }
  return arc;
}

std::vector<std::string> obstacle_names(const Model& model) {
  std::vector<std::string> names;
  for (const Obstacle& obstacle : model.obstacles) names.push_back(obstacle.name);
  return names;
}

const std::vector<std::pair<const char*, std::vector<std::string>>>& axis_names() {
  static const std::vector<std::pair<const char*, std::vector<std::string>>> names = {
      {axis_labels, {"x", "y", "z"}},
      {plate_labels, {"y", "z"}},
      {contact_labels, {"first", "last"}},
      {strand_labels, {"first_a", "first_b", "last_a", "last_b"}}};
  return names;
}

std::vector<std::pair<std::string, std::vector<std::string>>> enumerations() {
  std::vector<std::string> phases, meanings, forces{"tip", "active"}, losses, knots, invariants;
  for (const PhaseEntry& phase : phase_table) {
    phases.emplace_back(phase.name);
    meanings.emplace_back(phase.description);
  }
  for (const RowKindEntry& kind : row_kind_table) forces.emplace_back(kind.name);
  for (const EnergyColumn& loss : energy_losses) losses.emplace_back(loss.name);
  for (const NamedKnot& knot : named_knots()) {
    knots.emplace_back(knot.name);
    invariants.push_back(invariants_text(knot.type));
  }
  return {{"/enumerations/phase", phases}, {"/enumerations/phase_description", meanings},
          {"/enumerations/force", forces}, {"/enumerations/loss", losses},
          {"/enumerations/knot", knots},   {"/enumerations/knot_invariants", invariants}};
}

/// Which muscles there are, and how strong.
void write_muscles(const Model& model, Hdf5Writer& h5) {
  std::vector<std::string> names;
  Eigen::VectorXd force(static_cast<Eigen::Index>(model.muscles.size()));
  for (const Muscle& muscle : model.muscles) {
    force[static_cast<Eigen::Index>(names.size())] =
        muscle.force * static_cast<double>(muscle.lines.size());
    names.push_back(muscle.name);
  }
  h5.texts(muscle_labels, names);
  h5.make_labels(muscle_labels);
  h5.numbers("/model/muscle_force", force,
             {"dyn", "largest force of each muscle, all of its lines together"});
  h5.label("/model/muscle_force", {muscle_labels});
}

void write_model(const Model& model, Hdf5Writer& h5) {
  const int n = model.body_count();
  Eigen::VectorXd mass(n), length(n), radius(n);
  for (int b = 0; b < n; ++b) {
    mass[b] = model.bodies[b].mass;
    length[b] = model.bodies[b].length;
    radius[b] = model.bodies[b].radius;
  }
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(model.nv(), -INFINITY);
  Eigen::VectorXd upper = -lower;
  const Eigen::Matrix2Xd ranges = hinge_ranges(model);
  lower.tail(ranges.cols()) = ranges.row(0);
  upper.tail(ranges.cols()) = ranges.row(1);
  std::vector<std::string> joints, dofs;
  for (const JointName& joint : joint_names(model)) {
    joints.push_back(joint.joint);
    dofs.insert(dofs.end(), joint.dofs.begin(), joint.dofs.end());
  }
  h5.group("/enumerations");
  for (const auto& [path, names] : enumerations()) h5.texts(path, names);
  h5.group("/model");
  h5.numbers(body_labels, body_arcs(model),
             {"cm", "arc length of each body's middle from the head's end at rest"});
  h5.numbers("/model/mass", mass, {"g", "mass of each body, head to tail"});
  h5.numbers("/model/length", length, {"cm", "length of each body"});
  h5.numbers("/model/radius", radius, {"cm", "radius of the skin at each body"});
  h5.texts(joint_labels, joints);
  h5.texts(dof_labels, dofs);
  h5.texts(coordinate_labels, coordinate_names(model));
  if (!model.muscles.empty()) write_muscles(model, h5);
  if (!model.obstacles.empty()) {
    h5.texts(obstacle_names_path, obstacle_names(model));
    h5.make_labels(obstacle_names_path);
  }
  for (const auto& [path, names] : axis_names()) {
    h5.texts(path, names);
    h5.make_labels(path);
  }
  for (const char* path : {body_labels, joint_labels, dof_labels, coordinate_labels}) {
    h5.make_labels(path);
  }
  h5.numbers("/model/limit_lower", lower,
             {"rad",
              "lower joint limit, -inf where none; where the total angle of a joint is bounded "
              "(bending_limit), what this leaves each hinge by itself"});
  h5.numbers("/model/limit_upper", upper,
             {"rad", "upper joint limit, +inf where none, as limit_lower"});
  h5.numbers("/model/bending_limit", bending_limits(model),
             {"rad",
              "largest angle between the X axes of the two bodies of each joint, +inf where "
              "its hinges have limits of their own or there are none"});
  for (const char* path : {"/model/mass", "/model/length", "/model/radius"}) {
    h5.label(path, {body_labels});
  }
  for (const char* path : {"/model/limit_lower", "/model/limit_upper"}) {
    h5.label(path, {dof_labels});
  }
  h5.label("/model/bending_limit", {joint_labels});
}

}  // namespace hagfish
