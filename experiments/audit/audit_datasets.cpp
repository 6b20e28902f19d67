#include "experiments/audit/audit_datasets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5_hl.h>

#include "core/log/axis_labels.hpp"
#include "core/log/build_info.hpp"
#include "core/log/coordinate_names.hpp"
#include "core/log/log_writer.hpp"
#include "core/log/saved_run.hpp"
#include "core/log/seal.hpp"
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
        "{}: has no {}: hagfish {} wrote it at revision {}, before logs had one. Check it with "
        "that revision or run its scene again; view and export can read it",
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

/// Other revisions may have had other words.
void check_own_words(const Hdf5Reader& h5, const SeriesLayout& layout) {
  const auto require = [&](bool same, const char* what) {
    if (!same) throw FileError(h5.file() + ": " + layout.path + " has another " + what);
  };
  require(h5.attribute(layout.path, "unit") == layout.meaning.unit, "unit");
  require(h5.attribute(layout.path, "description") == layout.meaning.description, "description");
  const H5::DataSet set = h5.open(layout.path);
  if (layout.type.getClass() == H5T_ENUM) {
    require(set.getDataType() == layout.type, "enumeration");
  }
  for (std::size_t axis = 0; axis < layout.labels.size(); ++axis) {
    const std::string& labels = layout.labels[axis];
    if (labels.empty() || labels == layout.path) continue;
    require(H5DSis_attached(set.getId(), h5.open(labels).getId(), static_cast<unsigned>(axis)) > 0,
            "label on an axis");
  }
}

}  // namespace

void check_datasets(const LogContents& log) {
  require_own_version(log);
  const hsize_t step_count = log.h5.shape("/steps/kkt").at(0);
  const auto stride = static_cast<hsize_t>(frame_stride(log.resolved.scene.time));
  const hsize_t covered = static_cast<hsize_t>(log.begun - 1) * stride + 1;
  if (step_count < covered || step_count >= covered + stride) {
    throw FileError(fmt::format("{}: /steps has {} steps, {} frames make {} to {}", log.h5.file(),
                                step_count, log.begun, covered, covered + stride - 1));
  }
  for (const DatasetForm& form : log_forms(log.h5, log.model, log.resolved.scene)) {
    check_form(log.h5, form);
    check_words(log.h5, form.path);
    if (log.h5.root_text("git_revision") == build_revision()) {
      check_own_words(log.h5, *form.layout);
    }
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

Finding audit_seal(const LogContents& log) {
  if (!log.h5.has(seal_path)) {
    const bool ended = log.h5.root_text("status") != "running";
    const bool taken = ended && log.h5.root_text("git_revision") == build_revision();
    const char* why = taken   ? "taken out: logs of this revision have one"
                      : ended ? "not sealed: made by another revision"
                              : "not sealed: the run has not ended";
    return {"seal", !taken, why, "", "", ""};
  }
  const Seal then = read_seal(log.h5.text(seal_path));
  const H5::DataSet any = log.h5.open("/trajectory/time");
  const auto changed = guarded(log.h5.file(), "look for changes",
                               [&] { return changes(then, seal_of(any.getId())); });
  return judged(
      {"seal", static_cast<double>(changed.size()), 0, "changes"},
      changed.empty()
          ? fmt::format("{} datasets and attributes are as the log's end left them", then.size())
          : fmt::format("since the log ended {}", fmt::join(changed, ", ")));
}

}  // namespace hagfish
