#include "core/log/log_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "core/chain/skin_fold.hpp"
#include "core/log/end_of_run.hpp"
#include "core/log/log_frame.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

// From one save to the next: at least so many s of wall time, this share of what has passed, and so
// many times what the last save took. Each save copies the log, a run of an hour some 70 times.
constexpr double save_interval = 1;
constexpr double save_share = 0.1;
constexpr double save_price = 30;
// Rows that wait for a save take at most so much memory, bytes.
constexpr std::size_t most_waiting = std::size_t{1} << 26;
// What a save may add besides rows: attributes and their heap, bytes.
constexpr std::size_t attribute_room = 131072;
// Memory that HDF5 takes to open a file and to write what is new, at most, beside copies of it,
// bytes.
constexpr std::size_t hdf5_memory = std::size_t{16} << 20;

/// Names the axes of series that are there.
void label_series(const SeriesList& series, Hdf5Writer& h5) {
  const auto each = [&](auto visit) {
    for (const auto& s : series) visit(s->layout());
  };
  each([&](const SeriesLayout& s) {
    if (!s.labels.empty() && s.labels[0] == s.path) h5.make_labels(s.path);
  });
  each([&](const SeriesLayout& s) { h5.label(s.path, s.labels); });
}

[[noreturn]] void fail(const fs::path& file, int error) {
  throw FileError(file.string() + ": cannot be saved: " + std::strerror(error));
}

}  // namespace

struct LogWriter::Contents {
  Contents(Model of, const Scene& scene, LogLevel level, OutputFile& to)
      : model(std::move(of)),
        frames(frame_table(model, scene, level)),
        steps(step_table(scene, level)),
        contacts(contact_table(scene, level)),
        rows(row_table(level)),
        with_rows(law_of(scene).logs_rows),
        means(model.nv()),
        moments(model),
        knot(scene.knot),
        time(scene.time),
        stride(frame_stride(scene.time)),
        output(to),
        part(to.partial()),
        next(part.string() + ".next") {
    for (const SeriesList& table : {frames.series(), steps.series(), contacts.series(),
                                    with_rows ? rows.series() : SeriesList()}) {
      series.insert(series.end(), table.begin(), table.end());
    }
  }

  std::int32_t frame_count() const {
    return static_cast<std::int32_t>(frames.series().front()->rows());
  }

  std::size_t waiting_bytes() const {
    std::size_t bytes = 0;
    for (const auto& s : series) bytes += s->waiting_bytes();
    return bytes;
  }

  /// The muscles' part of a frame.
  void see_muscles(const StepRecord& record, const FrameMeans& mean) {
    const Eigen::VectorXd torque = mean.active_torque + mean.force[RowKind::thigmotaxis];
    if (torque.allFinite()) {
      activations.solve(model, record.after.observation.kin, torque, muscles);
    } else {
      muscles.activation.setConstant(model.muscle_count(), NAN);
      muscles.residual.setConstant(model.nv(), NAN);
    }
  }

  /// A frame of `record`, and of the means and the worst since the one before.
  void append_frame(const StepRecord& record, const ThigmotaxisRows& rows_of_step) {
    const FrameMeans& mean = means.close();
    const KnotVote type = record.controller.knot_seen == record.time
                              ? record.controller.knot
                              : knot_type(record.after.observation.kin.centre, knot);
    if (!model.muscles.empty()) see_muscles(record, mean);
    const double fold = skin_fold(model, record.after.observation.kin);
    frames.append(
        {record, rows_of_step, mean, moments.close(), type, fold, worst, wall_time, muscles});
    worst = {};
  }

  /// The state at the end as a frame.
  void append_end(const Simulation& sim) {
    const StepRecord end =
        end_record(model, static_cast<double>(sim.step) * time.step, sim, clamped);
    const double kkt = worst.kkt;  // the end has none
    worst.take(end);
    worst.kkt = kkt;
    append_frame(end, thigmotaxis_rows_of(end.control, end.solution, time.step));
  }

  /// Changes FILE.part.next, which first becomes what FILE.part holds where it is not more.
  void change(const std::map<std::string, std::string>& attributes, const SeriesList& written) {
    std::size_t room = attribute_room;
    for (const auto& s : written) room += s->room();
    require_memory(hdf5_memory + 2 * room);
    try {
      std::error_code error;
      if (!ahead) fs::copy_file(part, next, fs::copy_options::overwrite_existing, error);
      if (error) fail(part, error.value());
      if (const int full = reserve_room(next, room); full != 0) fail(part, full);
      Hdf5Writer h5(next);
      for (const auto& s : written) s->write(h5);
      for (const auto& [name, value] : attributes) h5.root_attribute(name, value);
      h5.close();
    } catch (const std::exception& failure) {
      if (ahead) lost = failure.what();
      drop();
      throw;
    }
    for (const auto& s : written) s->written();
    ahead = true;
  }

  /// FILE.part.next becomes FILE.part.
  void take_over() {
    output.put(next);
    ahead = false;
  }

  /// Brings FILE.part up to date.
  void save() {
    if (!lost.empty()) throw FileError(lost);
    const auto begin = std::chrono::steady_clock::now();
    change(changed, series);
    take_over();
    any = true;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    next_save =
        wall_time + std::max({save_interval, save_share * wall_time, save_price * took.count()});
  }

  /// Sets the status of a log that cannot be saved any more; where that fails too, it stays.
  void mark_failed(const std::string& cause) {
    drop();
    try {
      change({{"status", "failed: " + cause}}, {});
      take_over();
    } catch (const std::exception&) {  // what is told is why the log could not be saved
    }
  }

  /// FILE.part.next goes.
  void drop() {
    std::error_code error;
    fs::remove(next, error);
    ahead = false;
  }

  Model model;
  LogTable<Frame> frames;
  LogTable<LoggedStep> steps;
  LogTable<BearingContact> contacts;
  LogTable<FrameRow> rows;
  bool with_rows;     // the log has that table
  SeriesList series;  // series of all tables
  RunningMeans means;
  MomentMeans moments;
  Worst worst;
  ActivationSolver activations;
  MuscleEffort muscles;
  KnotSettings knot;
  TimeSettings time;
  std::int64_t stride;                         // steps a frame
  std::map<std::string, std::string> changed;  // attributes of the root, for the next save
  OutputFile& output;
  fs::path part, next;
  bool ahead = false;  // FILE.part.next has all of FILE.part, and more
  std::string lost;    // why rows are, that FILE.part does not have and that wait no more
  bool any = false;    // FILE.part is this run's
  std::int64_t earlier_steps = 0;  // steps of what FILE.part was before
  double wall_time = 0;            // wall time of the last step, s
  bool clamped = false;            // the head was, in the last step
  double next_save = 0;            // wall time, s: the first step is saved at once
};

std::int64_t frame_stride(const TimeSettings& time) {
  return std::max<std::int64_t>(1, std::llround(time.frame_interval / time.step));
}

LogWriter::LogWriter(const fs::path& file, bool replace, const LogHeader& header,
                     const Model& model, const Scene& scene, std::optional<std::int64_t> steps)
    : output_(std::make_unique<OutputFile>(file, steps ? Existing::go_on : replaced_if(replace))),
      contents_(std::make_unique<Contents>(model, scene, header.level, *output_)) {
  require_memory(hdf5_memory);
  Hdf5Writer h5;
  write_header(header, h5);
  write_model(model, h5);
  for (const auto& series : contents_->series) series->create(h5);
  label_series(contents_->series, h5);
  h5.save(contents_->next);
  contents_->ahead = true;
  contents_->earlier_steps = steps.value_or(0);
}

LogWriter::~LogWriter() {
  if (contents_ && output_->is_ours()) contents_->drop();
}

void LogWriter::require_ours() const {
  if (output_->is_ours()) return;
  throw FileError(output_->partial().string() +
                  ": only the process that began this log can write to it");
}

void LogWriter::write(const StepRecord& record, const Simulation& sim, double wall_time) {
  require_ours();
  Contents& c = *contents_;
  for (const std::string& warning : record.warnings) {
    std::string& all = c.changed["warnings"];
    all += fmt::format("{}step {} (t = {:.4f} s): {}", all.empty() ? "" : "\n", record.step,
                       record.time, warning);
  }
  const ThigmotaxisRows rows = thigmotaxis_rows_of(record.control, record.solution, c.time.step);
  c.wall_time = wall_time;
  c.clamped = record.control.clamp_head;
  c.worst.take(record);
  c.steps.append({record, rows});
  const bool frame = record.step % c.stride == 0;
  if (frame) write_frame(record, rows);
  // The step that begins at a frame counts to the next one's means.
  c.means.take(record, rows);
  c.moments.take(c.model, c.time, record);
  if (wall_time >= c.next_save && sim.step >= c.earlier_steps) {
    c.save();
  } else if (frame && c.waiting_bytes() > most_waiting) {
    c.change({}, c.series);
  }
}

void LogWriter::write_frame(const StepRecord& record, const ThigmotaxisRows& rows) {
  Contents& c = *contents_;
  const std::int32_t frame = c.frame_count();
  c.append_frame(record, rows);
  const StepSolution& step = record.solution;
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    const Row& row = step.rows[i];
    const double force = step.lambda[static_cast<Eigen::Index>(i)] / c.time.step;
    if ((row.kind == RowKind::contact || row.kind == RowKind::obstacle) && force != 0) {
      c.contacts.append({frame, row, force});
    }
    if (row.kind == RowKind::thigmotaxis && c.with_rows) {
      c.rows.append({frame, thigmotaxis_row(record.control, step, i, c.time.step)});
    }
  }
}

void LogWriter::finish(const std::string& status, const Simulation& sim) {
  require_ours();
  Contents& c = *contents_;
  if (sim.step < c.earlier_steps) {
    throw FileError(fmt::format("{}: stays as it was: run again, it came to step {} of {}: {}",
                                c.output.earlier().string(), sim.step, c.earlier_steps, status));
  }
  try {
    c.changed["status"] = status;
    if (c.frame_count() > 0) c.append_end(sim);
    c.save();
  } catch (const std::exception& error) {
    if (!c.any) throw;
    const bool full = dynamic_cast<const FileError*>(&error) != nullptr;
    const std::string cause = full ? error.what() : "out of memory";
    c.mark_failed(cause);
    throw FileError(cause + "; " + c.part.string() + " has what was saved before");
  }
  output_->publish();
  contents_.reset();
}

}  // namespace hagfish
