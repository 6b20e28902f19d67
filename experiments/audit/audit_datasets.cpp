#include "experiments/audit/audit_datasets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/log/log_frame.hpp"
#include "core/log/log_writer.hpp"

namespace hagfish {
namespace {

/// Every dataset of a table, as the writer declares it, with `rows` rows.
template <class Source>
void check_table(const LogContents& log, const LogTable<Source>& table, hsize_t rows) {
  for (const auto& series : table.series()) {
    const std::string& path = series->layout().path;
    const std::vector<hsize_t>& row_shape = series->layout().row_shape;
    std::vector<hsize_t> shape{rows};
    shape.insert(shape.end(), row_shape.begin(), row_shape.end());
    if (log.h5.shape(path) != shape) {
      throw FileError(fmt::format("{}: {} has the shape ({}), not ({})", log.h5.file(), path,
                                  fmt::join(log.h5.shape(path), ", "), fmt::join(shape, ", ")));
    }
    if (log.h5.attribute(path, "unit").empty() || log.h5.attribute(path, "description").empty()) {
      throw FileError(log.h5.file() + ": " + path + " has no unit or description");
    }
  }
}

void check_names(const LogContents& log) {
  std::vector<std::string> joints, dofs;
  for (const JointName& joint : joint_names(log.model)) {
    joints.push_back(joint.joint);
    dofs.insert(dofs.end(), joint.dofs.begin(), joint.dofs.end());
  }
  for (const auto& [path, names] :
       {std::pair("/model/joint_name", joints), {"/model/dof_name", dofs}}) {
    if (log.h5.texts(path) != names) {
      throw FileError(log.h5.file() + ": " + path + " does not name the joints of its model");
    }
  }
}

}  // namespace

void check_datasets(const LogContents& log) {
  // The writer says what there must be; nothing is written.
  LogTable<Frame> frames(frame_chunk_rows);
  LogTable<LoggedStep> steps(step_chunk_rows);
  LogTable<BearingContact> contacts(step_chunk_rows);
  declare_frames(log.model, frames);
  declare_steps(steps);
  declare_contacts(contacts);
  const hsize_t step_count = log.h5.shape("/steps/kkt").at(0);
  const auto stride = static_cast<hsize_t>(frame_stride(log.resolved.scene.time));
  const hsize_t covered = (log.time.size() - 1) * stride + 1;
  if (step_count < covered || step_count >= covered + stride) {
    throw FileError(fmt::format("{}: /steps has {} steps, {} frames make {} to {}", log.h5.file(),
                                step_count, log.time.size(), covered, covered + stride - 1));
  }
  check_table(log, frames, log.time.size());
  check_table(log, steps, step_count);
  check_table(log, contacts, log.h5.shape("/contacts/frame").at(0));
  if (!log.h5.has("/model/bending_limit")) {
    throw FileError(log.h5.file() + ": has no /model/bending_limit");
  }
  check_names(log);
}

}  // namespace hagfish
