#include "core/log/reading/log_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/log/log_frame.hpp"
#include "core/log/log_writer.hpp"
#include "core/log/reading/logged_run.hpp"

namespace hagfish {
namespace {

// Values that no animal comes to; figures of physics overflow long after these.
constexpr double furthest_position = 1e6;  // position of the head, cm
constexpr double largest_angle = 1e3;      // angle of a hinge, rad
constexpr double largest_velocity = 1e9;   // cm/s, rad/s
/// Doubles count steps exactly up to here.
constexpr std::int64_t most_steps = std::int64_t{1} << 53;
/// The norm of the head's quaternion, 1 but for rounding, is at least this and at most one over it.
constexpr double least_norm = 0.5;

/// Datasets that no command goes without where a log of this scene has them, and such groups.
constexpr std::string_view needed_datasets[] = {"/trajectory/time",
                                                "/trajectory/q",
                                                "/trajectory/qdot",
                                                "/trajectory/position",
                                                "/trajectory/qdot_next",
                                                "/trajectory/phase",
                                                "/trajectory/step",
                                                "/thigmotaxis/body_b",
                                                "/knot/determinant",
                                                "/knot/v2",
                                                "/knot/head_end",
                                                "/knot/tail_end",
                                                "/steps/eq6",
                                                "/diagnostics/wall_time",
                                                "/steps/kkt"};
const std::vector<std::string> needed_groups = {"/forces/", "/midway/", "/eq6/",   "/control/",
                                                "/basis/",  "/reflex/", "/muscle/"};

/// Type and extents of a dataset.
struct DatasetForm {
  std::string path;
  std::vector<hsize_t> shape;
  H5T_class_t type;
};

[[noreturn]] void refuse(const Hdf5Reader& log, const std::string& what) {
  throw FileError(log.file() + ": " + what);
}

const char* type_name(H5T_class_t type) {
  switch (type) {
    case H5T_FLOAT:
      return "floating-point numbers";
    case H5T_INTEGER:
      return "whole numbers";
    case H5T_ENUM:
      return "an enumeration";
    default:
      return "something else";
  }
}

hsize_t rows_of(const Hdf5Reader& log, const std::string& path) {
  const std::vector<hsize_t> shape = log.shape(path);
  if (shape.size() != 1) refuse(log, path + " is not a series");
  return shape[0];
}

void add_forms(const SeriesList& table, hsize_t rows, std::vector<DatasetForm>& forms) {
  for (const auto& series : table) {
    const SeriesLayout& layout = series->layout();
    forms.push_back({layout.path, layout.shape(rows), layout.type.getClass()});
  }
}

void check_memory(const Hdf5Reader& log, const std::vector<DatasetForm>& forms) {
  double wanted = 0;
  for (const DatasetForm& form : forms) {
    wanted += std::accumulate(form.shape.begin(), form.shape.end(), double{sizeof(double)},
                              std::multiplies<>());
  }
  const double there =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (wanted > there) {
    refuse(log, fmt::format("holds {:.3g} GB, more than the memory of this machine ({:.3g} GB)",
                            1e-9 * wanted, 1e-9 * there));
  }
}

void check_whole(const Hdf5Reader& log, const std::string& path, std::int64_t low,
                 std::int64_t high) {
  if (!log.has(path)) return;
  for (const std::int64_t value : log.integers(path)) {
    if (value < low || value > high) {
      refuse(log, fmt::format("{} holds {}, not {} to {}", path, value, low, high));
    }
  }
}

void check_steps(const Hdf5Reader& log, const Scene& scene) {
  const std::vector<std::int64_t> step = log.integers("/trajectory/step");
  const std::int64_t stride = frame_stride(scene.time);
  check_whole(log, "/trajectory/step", 0, most_steps);
  const bool steps_known = holds(level_of(log), "/steps/kkt");
  for (std::size_t f = 1; f < step.size(); ++f) {
    const std::int64_t on = step[f] - step[f - 1];
    // The state at the end may come sooner after the frame before.
    const bool end = f + 1 == step.size() && (!steps_known || ends_with_end_frame(log));
    if (on != stride && !(end && on > 0 && on < stride)) {
      refuse(log,
             fmt::format(
                 "/trajectory/step goes from {} to {}, but its scene has {} steps between frames",
                 step[f - 1], step[f], stride));
    }
  }
  if (steps_known && !ends_with_end_frame(log) &&
      step.back() - step.front() >= static_cast<std::int64_t>(rows_of(log, "/steps/kkt"))) {
    refuse(log, "/steps does not cover the frames");
  }
  const std::vector<double> time = log.doubles("/trajectory/time");
  for (std::size_t f = 0; f < time.size(); ++f) {
    if (!std::isfinite(time[f]) || (f > 0 && time[f] <= time[f - 1])) {
      refuse(log,
             fmt::format("/trajectory/time holds {:g} s at frame {}: times must rise", time[f], f));
    }
  }
}

void check_motion(const Hdf5Reader& log) {
  const auto within = [&log](const std::string& path, const auto& values, double most) {
    for (const double value : values.reshaped()) {
      if (!(std::abs(value) <= most)) {
        refuse(log, fmt::format("{} holds {:g}, not a number up to {:g}", path, value, most));
      }
    }
  };
  const Hdf5Reader::Rows q = log.rows("/trajectory/q");
  within("/trajectory/q", q.leftCols<3>(), furthest_position);
  within("/trajectory/q", q.rightCols(q.cols() - 3), largest_angle);
  for (Eigen::Index f = 0; f < q.rows(); ++f) {
    const double norm = q.row(f).segment<4>(3).norm();
    if (norm < least_norm || norm > 1 / least_norm) {
      refuse(log, fmt::format("/trajectory/q has a quaternion of norm {:g} at frame {}", norm, f));
    }
  }
  for (const char* path : {"/trajectory/qdot", "/trajectory/qdot_next", "/midway/moved",
                           "/midway/felt", "/midway/qdot"}) {
    if (!log.has(path)) continue;
    const Hdf5Reader::Rows velocities = log.rows(path);
    const bool stepped = std::string_view(path) != "/trajectory/qdot";
    const Eigen::Index none = stepped && ends_with_end_frame(log) ? 1 : 0;
    within(path, velocities.topRows(velocities.rows() - none), largest_velocity);
  }
}

/// Muscles pull by 0 to all of their force; nan where there is no mean yet.
void check_activations(const Hdf5Reader& log) {
  for (const char* path : {"/muscle/activation", "/muscle/driven"}) {
    if (!log.has(path)) continue;
    const Hdf5Reader::Rows activations = log.rows(path);
    for (const double a : activations.reshaped()) {
      if (a < 0 || a > 1) {
        refuse(log, fmt::format("{} holds {:g}, not an activation from 0 to 1", path, a));
      }
    }
  }
}

/// Every dataset along frames, steps and contacts as the writer of logs declares it, with the rows
/// that this log has of each.
std::vector<DatasetForm> log_forms(const Hdf5Reader& log, const Model& model, const Scene& scene) {
  // The writer says what there must be; nothing is written.
  const LogLevel level = level_of(log);
  std::vector<DatasetForm> forms;
  const auto add = [&](const SeriesList& table, const char* counted) {
    if (holds(level, counted)) add_forms(table, rows_of(log, counted), forms);
  };
  add(frame_table(model, scene, level).series(), "/trajectory/time");
  add(step_table(scene, level).series(), "/steps/kkt");
  add(contact_table(scene, level).series(), "/contacts/frame");
  if (law_of(scene).logs_rows) add(row_table(level).series(), "/eq6/frame");
  return forms;
}

void check_form(const Hdf5Reader& log, const DatasetForm& form) {
  if (const H5T_class_t type = log.type(form.path); type != form.type) {
    refuse(log,
           fmt::format("{} holds {}, not {}", form.path, type_name(type), type_name(form.type)));
  }
  if (const std::vector<hsize_t> shape = log.shape(form.path); shape != form.shape) {
    refuse(log, fmt::format("{} has the shape ({}), not ({}), that of its model and frames",
                            form.path, fmt::join(shape, ", "), fmt::join(form.shape, ", ")));
  }
}

}  // namespace

bool ends_with_end_frame(const Hdf5Reader& log) {
  const std::vector<std::int64_t> step = log.integers("/trajectory/step");
  return step.size() > 1 && holds(level_of(log), "/steps/kkt") &&
         step.back() == step.front() + static_cast<std::int64_t>(rows_of(log, "/steps/kkt"));
}

void check_schema(const Hdf5Reader& log, const Model& model, const Scene& scene) {
  const std::vector<DatasetForm> forms = log_forms(log, model, scene);
  for (const DatasetForm& form : forms) {
    const bool needed = any_begins(form.path, needed_groups) ||
                        std::ranges::find(needed_datasets, form.path) != std::end(needed_datasets);
    if (needed || log.has(form.path)) check_form(log, form);
  }
  if (rows_of(log, "/trajectory/time") == 0) refuse(log, "holds no frames");
  check_memory(log, forms);
  check_steps(log, scene);
  if (holds(level_of(log), "/trajectory/q")) check_motion(log);
  check_activations(log);
  const auto frames = static_cast<std::int64_t>(rows_of(log, "/trajectory/time"));
  constexpr auto last_solve = static_cast<std::int64_t>(SolveKind::qp);
  check_whole(log, "/trajectory/phase", 0, static_cast<int>(Phase::last));
  check_whole(log, "/steps/solve", 0, last_solve);
  check_whole(log, "/diagnostics/solve", 0, last_solve);
  check_whole(log, "/contacts/frame", 0, frames - 1);
  check_whole(log, "/contacts/obstacle", -1, static_cast<std::int64_t>(model.obstacles.size()) - 1);
  check_whole(log, "/eq6/frame", 0, frames - 1);
  check_whole(log, "/eq6/end", 0, 2);
  check_whole(log, "/eq6/along", 0, 1);
  check_whole(log, "/eq6/towards", -1, 1);
  for (const char* path : {"/thigmotaxis/body_a", "/thigmotaxis/body_b"}) {
    check_whole(log, path, -1, model.body_count() - 1);
  }
}

}  // namespace hagfish
