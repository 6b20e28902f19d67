#include "core/log/log_writer.hpp"
#include "core/chain/skin_fold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/log/disk_room.hpp"
#include "core/log/end_of_run.hpp"
#include "core/log/frame_rows.hpp"
#include "core/log/log_frame.hpp"
#include "core/log/log_step.hpp"
#include "core/log/seal.hpp"
#include "core/log/twin_file.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

// From one save to the next, s of wall time.
constexpr double save_interval = 1;
// What a save may add besides rows and checkpoints: attributes and their heap, a seal, bytes.
constexpr std::size_t attribute_room = 131072;
// Memory that HDF5 takes to open two files and to write what is new, at most, beside copies of it,
// bytes.
constexpr std::size_t hdf5_memory = std::size_t{16} << 20;
// Checkpoints are some 20 kB each at 100 bodies. Compressed they would take half of that, and a run
// of the Table 1 scene 2.5 % longer.
constexpr hsize_t checkpoint_chunk = 32768;
constexpr hsize_t mark_chunk = 64;  // rows

/// Which bytes of /checkpoints/data are a checkpoint.
struct CheckpointMark {
  std::int64_t step = 0;  ///< the step that it precedes
  std::int64_t end = 0;   ///< behind its last byte
};

LogTable<CheckpointMark> checkpoint_table(LogLevel level) {
  LogTable<CheckpointMark> t({.level = level, .labels = "", .chunk_rows = mark_chunk});
  t.index("/checkpoints/step", "index of the step before which the run stood so",
          [](const CheckpointMark& mark) { return mark.step; });
  t.index("/checkpoints/end", "where its bytes in /checkpoints/data end",
          [](const CheckpointMark& mark) { return mark.end; });
  return t;
}

SeriesLayout checkpoint_bytes() {
  SeriesLayout layout = layout_of<std::uint8_t>(
      checkpoint_data, {}, {"1", "runs between two steps, one after the other, as bytes"});
  layout.chunk_rows = checkpoint_chunk;
  return layout;
}

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

/// Sets the status of a log that cannot be saved any more; where that fails too, it stays.
void mark_failed(const fs::path& file, const std::string& cause) {
  if (reserve_room(file, attribute_room) != 0) {
    return;
  }
  try {
    require_memory(hdf5_memory);
    Hdf5Writer h5(file);
    h5.root_attribute("status", "failed: " + cause);
    h5.close();
  } catch (const std::exception&) {  // what is told is why the log could not be saved
  }
}

}  // namespace

struct LogWriter::Contents {
  Contents(Model of, const Scene& scene, LogLevel held)
      : model(std::move(of)),
        level(held),
        frames(frame_table(model, scene, held)),
        steps(step_table(scene, held)),
        contacts(contact_table(scene, held)),
        rows(row_table(held)),
        with_rows(law_of(scene).logs_rows),
        marks(checkpoint_table(held)),
        bytes(std::make_shared<Series<std::uint8_t>>(checkpoint_bytes())),
        log{RunningMeans(model.nv()), {}, {}},
        knot(scene.knot),
        h(scene.time.step),
        stride(frame_stride(scene.time)),
        mark_stride(checkpoint_stride(scene.time)) {
    tables = {frames.series(), steps.series(), contacts.series(), marks.series()};
    if (with_rows) tables.push_back(rows.series());
    if (holds(level, checkpoint_data)) tables.push_back({bytes});
    for (const auto& list : tables) {
      series.insert(series.end(), list.begin(), list.end());
    }
  }

  /// Goes on behind the rows that `h5` has of `table`, but for the last ones that `dropped` counts.
  static void go_on(const Hdf5Reader& h5, const SeriesList& table, hsize_t dropped) {
    if (table.empty()) return;
    const std::vector<hsize_t> first = h5.shape(table.front()->layout().path);
    const hsize_t rows = first.empty() ? 0 : first[0];
    for (const auto& s : table) {
      const SeriesLayout& layout = s->layout();
      if (h5.shape(layout.path) != layout.shape(rows)) {
        throw FileError(fmt::format("{}: {} does not have the rows of {}", h5.file(), layout.path,
                                    table.front()->layout().path));
      }
      s->go_on(rows - dropped);
    }
  }

  std::int32_t frame_count() const {
    return static_cast<std::int32_t>(frames.series().front()->rows());
  }

  /// The muscles' part of a frame.
  void see_muscles(const StepRecord& record, const FrameMeans& mean) {
    const Eigen::VectorXd torque = mean.active_torque + mean.force[RowKind::thigmotaxis];
    if (torque.allFinite()) {
      activations.solve(model, record.moment.observation.kin, torque, muscles);
    } else {
      muscles.activation.setConstant(static_cast<Eigen::Index>(model.muscles.size()), NAN);
      muscles.residual.setConstant(model.nv(), NAN);
    }
  }

  /// A frame of `record`, and of the means and the `worst` since the one before.
  void append_frame(const StepRecord& record, const ThigmotaxisRows& rows_of_step,
                    const FrameMeans& mean, const Worst& worst) {
    const KnotVote type = record.controller.knot_seen == record.time
                              ? record.controller.knot
                              : knot_type(record.moment.observation.kin.centre, knot);
    if (!model.muscles.empty()) see_muscles(record, mean);
    const double fold = skin_fold(model, record.moment.observation.kin);
    frames.append({record, rows_of_step, mean, type, fold, worst, wall_time, muscles});
  }

  /// The state at the end as a frame. What a run goes on with, `log`, does not know of it.
  void append_end(const Simulation& sim) {
    const StepRecord end = end_record(model, static_cast<double>(sim.step) * h, sim, clamped);
    Worst worst = log.worst;
    worst.take(end);
    worst.kkt = log.worst.kkt;
    RunningMeans means = log.means;
    append_frame(end, thigmotaxis_rows_of(end.control, end.solution, h), means.close(), worst);
  }

  /// Brings FILE.part up to date; `sim` is the run after all that it then holds. The last one is
  /// sealed.
  void save(const Simulation& sim, bool last = false) {
    if (file->prepare()) {
      std::ranges::for_each(series, [](const auto& s) { s->files_are_alike(); });
    }
    const std::vector<std::uint8_t> now = encode(sim, log);
    std::size_t room = attribute_room + now.size();
    for (const auto& s : series) {
      room += s->room();
    }
    require_memory(hdf5_memory + 2 * room);
    try {
      const fs::path& next = file->begin(room);
      Hdf5Writer h5(next);
      const Hdf5Reader newer(file->whole(), Origin::own);
      std::ranges::for_each(series, [&](const auto& s) { s->write(newer, h5); });
      h5.bytes(last_checkpoint, now, "the run where the log ends, as bytes");
      for (const auto& [name, value] : attributes) {
        h5.root_attribute(name, value);
      }
      if (last) seal_file(next);  // while it is open: HDF5 then need not read it anew
      h5.close();
    } catch (...) {
      file->abandon();
      throw;
    }
    file->commit();
    std::ranges::for_each(series, [](const auto& s) { s->saved(); });
    any = true;
  }

  Model model;
  LogLevel level;
  LogTable<Frame> frames;
  LogTable<LoggedStep> steps;
  LogTable<BearingContact> contacts;
  LogTable<FrameRow> rows;
  bool with_rows;  // the log has that table
  LogTable<CheckpointMark> marks;
  std::shared_ptr<Series<std::uint8_t>> bytes;  // of the checkpoints
  std::vector<SeriesList> tables;               // lists that have as many rows each
  SeriesList series;                            // all of them
  LogState log;
  ActivationSolver activations;
  MuscleEffort muscles;
  KnotSettings knot;
  double h;
  std::int64_t stride;                            // steps a frame
  std::int64_t mark_stride;                       // and a checkpoint
  std::map<std::string, std::string> attributes;  // of the root, to be set by the next save
  std::optional<TwinFile> file;
  double wall_time = 0;  // of the last step, s
  bool clamped = false;  // the head was, in the last step
  double next_save = 0;  // wall time, s: the first step is saved at once
  bool any = false;      // a step has been saved
};

std::int64_t frame_stride(const TimeSettings& time) {
  return std::max<std::int64_t>(1, std::llround(time.frame_interval / time.step));
}

std::int64_t checkpoint_stride(const TimeSettings& time) {
  const auto frames = std::llround(time.checkpoint_interval / time.frame_interval);
  return frame_stride(time) * std::max<std::int64_t>(1, frames);
}

LogWriter::LogWriter(const fs::path& file, bool replace, const LogHeader& header,
                     const Model& model, const Scene& scene)
    : output_(std::make_unique<OutputFile>(file, replaced_if(replace))),
      contents_(std::make_unique<Contents>(model, scene, header.level)) {
  require_memory(hdf5_memory);
  Hdf5Writer h5;
  write_header(header, h5);
  write_model(model, h5);
  h5.group("/checkpoints");
  for (const auto& series : contents_->series) {
    series->create(h5);
  }
  label_series(contents_->series, h5);
  h5.save(output_->partial());
  contents_->file.emplace(output_->partial());
}

LogWriter::LogWriter(const fs::path& file, const SavedRun& run, const Hdf5Reader& read)
    : contents_(std::make_unique<Contents>(run.model, run.resolved.scene, run.level)) {
  Contents& c = *contents_;
  const bool ended = has_end_frame(read, run.sim.step);
  const SeriesList frames = c.frames.series();
  for (const SeriesList& table : c.tables) {
    c.go_on(read, table, ended && table == frames ? 1 : 0);
  }
  const bool whole = fs::exists(file);
  output_ = std::make_unique<OutputFile>(file, Existing::go_on);
  const fs::path next = output_->partial().string() + ".next";
  try {
    read.write_to(next);
    unseal_file(next);
    if (ended) drop_end_frame(next, frames, frames.front()->rows() + 1);
    fs::rename(next, output_->partial());
  } catch (...) {  // a log that cannot be gone on with stays as it was
    std::error_code error;
    fs::remove(next, error);
    if (whole) output_->publish();
    throw;
  }
  c.log = run.log;
  c.wall_time = run.wall_time;
  c.clamped = clamps_head(run.resolved.scene, run.sim.controller.phase);
  c.attributes["status"] = "running";
  c.attributes["resumed"] =
      fmt::format("{}{}{}", run.resumed, run.resumed.empty() ? "" : ", ", run.sim.step);
  c.next_save = run.wall_time + save_interval;
  c.any = true;
  c.file.emplace(output_->partial());
}

LogWriter::~LogWriter() {
  if (!contents_) return;
  if (!output_->is_ours()) {
    if (contents_->file) contents_->file->forget();
  } else if (!contents_->any) {
    std::error_code error;
    fs::remove(output_->partial(), error);
  }
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
    c.log.warnings +=
        fmt::format("{}step {} (t = {:.4f} s): {}", c.log.warnings.empty() ? "" : "\n", record.step,
                    record.time, warning);
    c.attributes["warnings"] = c.log.warnings;
  }
  const ThigmotaxisRows rows = thigmotaxis_rows_of(record.control, record.solution, c.h);
  c.wall_time = wall_time;
  c.clamped = record.control.clamp_head;
  c.log.worst.take(record);
  c.steps.append({record, rows});
  if (record.step % c.stride == 0) {
    write_frame(record, rows);
  }
  // The step that begins at a frame counts to the next one's means.
  c.log.means.take(record, rows);
  if (sim.step % c.mark_stride == 0 && holds(c.level, checkpoint_data)) {
    const std::vector<std::uint8_t> bytes = encode(sim, c.log);
    c.bytes->append_all(bytes);
    c.marks.append({sim.step, static_cast<std::int64_t>(c.bytes->rows())});
  }
  if (wall_time >= c.next_save) {
    c.save(sim);
    c.next_save = wall_time + save_interval;
  }
}

void LogWriter::write_frame(const StepRecord& record, const ThigmotaxisRows& rows) {
  Contents& c = *contents_;
  const std::int32_t frame = c.frame_count();
  c.append_frame(record, rows, c.log.means.close(), c.log.worst);
  const StepSolution& step = record.solution;
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    const Row& row = step.rows[i];
    const double force = step.lambda[static_cast<Eigen::Index>(i)] / c.h;
    if ((row.kind == RowKind::contact || row.kind == RowKind::obstacle) && force != 0) {
      c.contacts.append({frame, row, force});
    }
    if (row.kind == RowKind::thigmotaxis && c.with_rows) {
      c.rows.append({frame, thigmotaxis_row(record.control, step, i, c.h)});
    }
  }
  c.log.worst = {};
}

void LogWriter::finish(const std::string& status, const Simulation& sim) {
  require_ours();
  Contents& c = *contents_;
  try {
    c.attributes["status"] = status;
    if (c.frame_count() > 0) c.append_end(sim);
    c.save(sim, true);
  } catch (const std::exception& error) {
    if (!c.any) {
      throw;
    }
    const bool full = dynamic_cast<const FileError*>(&error) != nullptr;
    const std::string cause = full ? error.what() : "out of memory";
    c.file.reset();
    mark_failed(output_->partial(), cause);
    throw FileError(cause + "; " + output_->partial().string() + " has what was saved before");
  }
  c.file.reset();
  output_->publish();
  contents_.reset();
}

}  // namespace hagfish
