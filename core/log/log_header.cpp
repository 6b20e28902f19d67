#include "core/log/log_header.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/knot/knot.hpp"
#include "core/log/axis_labels.hpp"
#include "core/log/build_info.hpp"
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

namespace {

/// Names that label the axes of other datasets.
void write_labels(const char* path, const std::vector<std::string>& names, Hdf5Writer& h5) {
  h5.texts(path, names);
  h5.make_labels(path);
}

/// Numbers along an axis that has `labels`.
void write_along(const char* labels, const char* path, const Eigen::VectorXd& values,
                 const Meaning& meaning, Hdf5Writer& h5) {
  h5.numbers(path, values, meaning);
  h5.label(path, {labels});
}

/// One number of each of a list.
template <class T, class Of>
Eigen::VectorXd each(const std::vector<T>& list, Of of) {
  Eigen::VectorXd values(std::ssize(list));
  std::ranges::transform(list, values.begin(), of);
  return values;
}

void write_bodies(const Model& model, Hdf5Writer& h5) {
  h5.numbers(body_labels, body_arcs(model),
             {"cm", "arc length of each body's middle from the head's end at rest"});
  h5.make_labels(body_labels);
  write_along(body_labels, "/model/mass", each(model.bodies, &Body::mass),
              {"g", "mass of each body, head to tail"}, h5);
  write_along(body_labels, "/model/length", each(model.bodies, &Body::length),
              {"cm", "length of each body"}, h5);
  write_along(body_labels, "/model/radius", each(model.bodies, &Body::radius),
              {"cm", "radius of the skin at each body"}, h5);
}

void write_joints(const Model& model, Hdf5Writer& h5) {
  std::vector<std::string> joints, dofs;
  for (const JointName& joint : joint_names(model)) {
    joints.push_back(joint.joint);
    dofs.insert(dofs.end(), joint.dofs.begin(), joint.dofs.end());
  }
  write_labels(joint_labels, joints, h5);
  write_labels(dof_labels, dofs, h5);
  write_labels(coordinate_labels, coordinate_names(model), h5);
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(model.nv(), -INFINITY);
  Eigen::VectorXd upper = -lower;
  const Eigen::Matrix2Xd ranges = hinge_ranges(model);
  lower.tail(ranges.cols()) = ranges.row(0);
  upper.tail(ranges.cols()) = ranges.row(1);
  write_along(dof_labels, "/model/limit_lower", lower,
              {"rad",
               "lower joint limit, -inf where none; where the total angle of a joint is bounded "
               "(bending_limit), what this leaves each hinge by itself"},
              h5);
  write_along(dof_labels, "/model/limit_upper", upper,
              {"rad", "upper joint limit, +inf where none, as limit_lower"}, h5);
  write_along(joint_labels, "/model/bending_limit", bending_limits(model),
              {"rad",
               "largest angle between the X axes of the two bodies of each joint, +inf where "
               "its hinges have limits of their own or there are none"},
              h5);
}

/// Which muscles there are, and how strong.
void write_muscles(const Model& model, Hdf5Writer& h5) {
  std::vector<std::string> names;
  for (const Muscle& muscle : model.muscles) names.push_back(muscle.name);
  write_labels(muscle_labels, names, h5);
  const auto whole = [](const Muscle& muscle) {
    return muscle.force * static_cast<double>(muscle.lines.size());
  };
  write_along(muscle_labels, "/model/muscle_force", each(model.muscles, whole),
              {"dyn", "largest force of each muscle, all of its lines together"}, h5);
}

}  // namespace

void write_model(const Model& model, Hdf5Writer& h5) {
  h5.group("/enumerations");
  for (const auto& [path, names] : enumerations()) h5.texts(path, names);
  h5.group("/model");
  write_bodies(model, h5);
  write_joints(model, h5);
  if (!model.muscles.empty()) write_muscles(model, h5);
  if (!model.obstacles.empty()) write_labels(obstacle_names_path, obstacle_names(model), h5);
  for (const auto& [path, names] : axis_names()) write_labels(path, names, h5);
}

}  // namespace hagfish
