#include "core/log/log_writer.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/log/build_info.hpp"
#include "core/log/log_frame.hpp"
#include "core/log/log_status.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

// Each save writes the whole log: no more often than this, s,
constexpr double save_interval = 1;
// and than this many times what the last save took, which bounds its share of the CPU time.
constexpr double save_share = 100;

std::string current_time() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", now);
}

void write_header(const LogHeader& header, Hdf5Writer& h5) {
  h5.root_attribute("format", log_format);
  h5.root_attribute("format_version", log_format_version);
  h5.root_attribute("creator", "hagfish");
  h5.root_attribute("creator_version", build_version());
  h5.root_attribute("git_revision", build_revision());
  h5.root_attribute("created", current_time());
  h5.root_attribute("command", header.command);
  h5.root_attribute("scene", header.scene);
  h5.root_attribute("qp", header.qp);
  h5.root_attribute("libraries", header.libraries);
  h5.root_attribute("compiler", build_compiler());
  h5.root_attribute("cpu", cpu_name());
  h5.root_attribute("status", "running");
  h5.root_attribute("warnings", "");
  h5.group("/mjcf");
  for (const auto& [name, text] : header.mjcf) {
    h5.text("/mjcf/" + name, text);
  }
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
  h5.group("/model");
  h5.numbers("/model/mass", mass, {"g", "mass of each body, head to tail"});
  h5.numbers("/model/length", length, {"cm", "length of each body"});
  h5.numbers("/model/radius", radius, {"cm", "radius of the skin at each body"});
  h5.texts("/model/joint_name", joints);
  h5.texts("/model/dof_name", dofs);
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
}

}  // namespace

struct LogWriter::Contents {
  Contents(const Model& model, const Scene& scene)
      : frames(h5),
        steps(h5),
        contacts(h5),
        means(model.nv()),
        knot(scene.knot),
        h(scene.time.step),
        stride(frame_stride(scene.time)) {
    declare_frames(model, h5, frames);
    declare_steps(h5, steps);
    declare_contacts(h5, contacts);
  }
  void save(const fs::path& file) {
    frames.flush();
    steps.flush();
    contacts.flush();
    h5.save(file);
  }

  Hdf5Writer h5;
  LogTable<Frame> frames;
  LogTable<LoggedStep> steps;
  LogTable<BearingContact> contacts;
  RunningMeans means;
  KnotSettings knot;
  double h;
  std::int64_t stride;  // steps a frame
  std::int32_t frame_count = 0;
  double next_save = save_interval;  // wall time, s
  bool saved = false;                // with a step in it
  Worst worst;
  std::string warnings;
};

std::int64_t frame_stride(const TimeSettings& time) {
  return std::max<std::int64_t>(1, std::llround(time.frame_interval / time.step));
}

LogWriter::LogWriter(const fs::path& file, bool replace, const LogHeader& header,
                     const Model& model, const Scene& scene)
    : file_(file, replace) {
  contents_ = std::make_unique<Contents>(model, scene);
  write_header(header, contents_->h5);
  write_model(model, contents_->h5);
  contents_->save(file_.partial());
}

LogWriter::~LogWriter() {
  if (contents_ && !contents_->saved) {
    std::error_code error;
    fs::remove(file_.partial(), error);
  }
}

void LogWriter::write(const StepRecord& record, double wall_time) {
  Contents& c = *contents_;
  for (const std::string& warning : record.warnings) {
    c.warnings += fmt::format("{}step {} (t = {:.4f} s): {}", c.warnings.empty() ? "" : "\n",
                              record.step, record.time, warning);
    c.h5.root_attribute("warnings", c.warnings);
  }
  const ThigmotaxisRows rows = thigmotaxis_rows_of(record.control, record.solution, c.h);
  c.worst.take(record);
  c.steps.append({record, rows});
  if (record.step % c.stride == 0) {
    write_frame(record, rows, wall_time);
  }
  // The step that begins at a frame counts to the next one's means.
  c.means.take(record, rows);
}

void LogWriter::write_frame(const StepRecord& record, const ThigmotaxisRows& rows,
                            double wall_time) {
  Contents& c = *contents_;
  const KnotVote knot = record.controller.knot_seen == record.time
                            ? record.controller.knot
                            : knot_type(record.moment.observation.kin.centre, c.knot);
  c.frames.append({record, rows, c.means.close(), knot, c.worst, wall_time});
  const StepSolution& step = record.solution;
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    const Row& row = step.rows[i];
    const double force = step.lambda[static_cast<Eigen::Index>(i)] / c.h;
    if ((row.kind == RowKind::contact || row.kind == RowKind::wall) && force != 0) {
      c.contacts.append({c.frame_count, row, force});
    }
  }
  ++c.frame_count;
  c.worst = {};
  if (wall_time >= c.next_save) {
    const auto begin = std::chrono::steady_clock::now();
    c.save(file_.partial());
    c.saved = true;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    c.next_save = wall_time + std::max(save_interval, save_share * took.count());
  }
}

void LogWriter::finish(const std::string& status) {
  try {
    contents_->h5.root_attribute("status", status);
    contents_->save(file_.partial());
  } catch (const std::exception& error) {
    if (!contents_->saved) {
      throw;
    }
    const bool full = dynamic_cast<const FileError*>(&error) != nullptr;
    const std::string cause = full ? error.what() : "out of memory";
    set_status_in_place(file_.partial(), "failed: " + cause);
    throw FileError(cause + "; " + file_.partial().string() + " has what was saved before");
  }
  contents_->saved = true;
  file_.publish();
  contents_.reset();
}

}  // namespace hagfish
