#include "experiments/audit/audit_datasets.hpp"

#include <fmt/format.h>

#include "core/log/axis_labels.hpp"
#include "core/log/coordinate_names.hpp"
#include "core/log/log_writer.hpp"
#include "core/log/saved_run.hpp"
#include "experiments/audit/audit_checkpoints.hpp"
#include "experiments/audit/log_schema.hpp"

namespace hagfish {
namespace {

void check_names(const LogContents& log) {
  std::vector<std::string> joints, dofs;
  for (const JointName& joint : joint_names(log.model)) {
    joints.push_back(joint.joint);
    dofs.insert(dofs.end(), joint.dofs.begin(), joint.dofs.end());
  }
  for (const auto& [path, names] : {std::pair("/model/joint_name", joints),
                                    {"/model/dof_name", dofs},
                                    {"/model/coordinate_name", coordinate_names(log.model)}}) {
    if (log.h5.texts(path) != names) {
      throw FileError(log.h5.file() + ": " + path + " does not name the joints of its model");
    }
  }
  if (!log.model.muscles.empty()) {
    std::vector<std::string> names;
    for (const Muscle& muscle : log.model.muscles) names.push_back(muscle.name);
    if (log.h5.texts(muscle_labels) != names) {
      throw FileError(log.h5.file() + ": " + muscle_labels + " does not name its muscles");
    }
  }
  for (const auto& [path, names] : enumerations()) {
    if (log.h5.texts(path) != names) {
      throw FileError(log.h5.file() + ": " + path + " is not the list of this program");
    }
  }
  // Logs of the head plate alone were without names.
  if ((!log.resolved.scene.obstacles.empty() || log.h5.has(obstacle_names_path)) &&
      log.h5.texts(obstacle_names_path) != obstacle_names(log.model)) {
    throw FileError(log.h5.file() + ": " + obstacle_names_path + " does not name its obstacles");
  }
  for (const auto& [path, names] : axis_names()) {
    if (log.h5.texts(path) != names) {
      throw FileError(log.h5.file() + ": " + path + " does not hold the names of its axis");
    }
  }
}

/// Logs of an earlier version may lack what is audited here; that version can audit them.
void require_own_version(const LogContents& log) {
  if (!is_of_earlier_version(log)) return;
  const auto require = [&log](const std::string& path) {
    if (log.h5.has(path)) return;
    throw FileError(fmt::format(
        "{}: has no {}: hagfish {} wrote it at revision {}, before logs had one; check it with "
        "that revision, or run its scene again (view and export read it)",
        log.h5.file(), path, log.h5.root_text("creator_version"),
        log.h5.root_text("git_revision")));
  };
  for (const DatasetForm& form : log_forms(log.h5, log.model, log.resolved.scene)) {
    require(form.path);
  }
  for (const auto& [path, names] : enumerations()) require(path);
}

void check_words(const Hdf5Reader& h5, const std::string& path) {
  if (h5.attribute(path, "unit").empty() || h5.attribute(path, "description").empty()) {
    throw FileError(h5.file() + ": " + path + " has no unit or description");
  }
}

}  // namespace

void check_datasets(const LogContents& log) {
  require_own_version(log);
  const hsize_t step_count = log.h5.shape("/steps/kkt").at(0);
  const auto stride = static_cast<hsize_t>(frame_stride(log.resolved.scene.time));
  const hsize_t covered = (log.time.size() - 1) * stride + 1;
  if (step_count < covered || step_count >= covered + stride) {
    throw FileError(fmt::format("{}: /steps has {} steps, {} frames make {} to {}", log.h5.file(),
                                step_count, log.time.size(), covered, covered + stride - 1));
  }
  for (const DatasetForm& form : log_forms(log.h5, log.model, log.resolved.scene)) {
    check_form(log.h5, form);
    check_words(log.h5, form.path);
  }
  for (const char* path :
       {"/checkpoints/step", "/checkpoints/end", checkpoint_data, last_checkpoint}) {
    check_words(log.h5, path);
  }
  for (const char* path : {"/model/bending_limit", body_labels}) {
    if (!log.h5.has(path)) throw FileError(log.h5.file() + ": has no " + path);
  }
  check_names(log);
}

}  // namespace hagfish
