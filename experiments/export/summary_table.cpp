#include <cmath>
#include <filesystem>
#include <limits>

#include "core/scene/phase.hpp"
#include "experiments/export/export_tables.hpp"
#include "experiments/judge/replay.hpp"

namespace hagfish {
namespace {

using namespace figure_unit;

/// Times of the frames of one phase, s; nan where it was not reached.
struct Stretch {
  std::size_t first = 0, last = 0;
  bool reached = false;
};

Stretch stretch_of(const LogContents& log, Phase phase) {
  Stretch stretch;
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    if (static_cast<Phase>(log.phase[f]) != phase) continue;
    if (!stretch.reached) stretch.first = f;
    stretch.last = f;
    stretch.reached = true;
  }
  return stretch;
}

/// The largest of some columns over the frames from `first` to `last`, in size; nan means count for
/// nothing.
struct Peak {
  double size = 0;
  Eigen::Index frame = -1, column = -1;  ///< none where all is 0
};

Peak peak_of(const Hdf5Reader::Rows& rows, Eigen::Index from_column, std::size_t first,
             std::size_t last) {
  Peak peak;
  for (auto f = static_cast<Eigen::Index>(first); f <= static_cast<Eigen::Index>(last); ++f) {
    for (Eigen::Index k = from_column; k < rows.cols(); ++k) {
      if (std::abs(rows(f, k)) > peak.size) peak = {std::abs(rows(f, k)), f, k};
    }
  }
  return peak;
}

/// (1/L) integral |f_thigmo| ds dt over the frames after `first`, dyn cm s: the three turns added.
double effort_of(const LogContents& log, const Hdf5Reader::Rows& force, std::size_t first,
                 std::size_t last) {
  double sum = 0;
  for (std::size_t f = first; f <= last; ++f) {
    for (std::size_t k = 0; k < log.model.hinges.size(); ++k) {
      const double size =
          std::abs(force(static_cast<Eigen::Index>(f), root_dofs + static_cast<Eigen::Index>(k)));
      const double span = hinge_span(log.model, log.model.hinges[k].body);
      sum += size * span / log.model.length() * (log.time[f] - log.time[f - 1]);
    }
  }
  return sum;
}

}  // namespace

ExportTable phases_table(const LogContents& log, bool si) {
  const auto at = [](const char* what) {
    return ExportColumn{std::string(what) + "_at", none, "the hinge"};
  };
  const auto when = [](const char* what) {
    return ExportColumn{std::string(what) + "_time", second, "the frame that ends that mean"};
  };
  ExportTable table(
      "phases.csv",
      {{"phase", none, "in the order of time"},
       {"from", second, "its first frame"},
       {"to", second, "the first frame of the next phase, or the last of the run"},
       {"largest_thigmotaxis", torque, "f_thigmo of any hinge, mean from frame to frame"},
       at("largest_thigmotaxis"),
       when("largest_thigmotaxis"),
       {"largest_active", torque, "torque of the muscles at any hinge, likewise"},
       at("largest_active"),
       when("largest_active"),
       {"muscle", none, "that with the largest activation; of scenes with muscles"},
       {"muscle_activation", none, "of it, mean from frame to frame"},
       {"muscle_time", second, "the frame that ends that mean"},
       {"muscle_basis", none, "guess: no muscle of a hagfish was measured along the body"},
       {"effort", torque_time, "size of f_thigmo, mean along the body, times time"},
       {"work_tip", energy, "of the scripted force on the tail, in this phase"},
       {"work_active", energy, "of the muscles, in this phase"},
       {"work_thigmotaxis", energy, "of f_thigmo, in this phase"},
       {"dissipated", energy, "lost to water drag and damping of joints and flesh, in this phase"}},
      si);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Hdf5Reader::Rows thigmotaxis = log.h5.rows("/mean/forces/thigmotaxis");
  const Hdf5Reader::Rows active = log.h5.rows("/mean/forces/active");
  const bool muscled = !log.model.muscles.empty();
  const Hdf5Reader::Rows activation =
      muscled ? log.h5.rows("/muscle/activation") : Hdf5Reader::Rows();
  for (const PhaseEntry& phase : phase_table) {
    const Stretch own = stretch_of(log, phase.value);
    if (!own.reached) continue;
    // What happens between two frames counts to the phase of the first.
    const std::size_t first = own.first + 1, last = std::min(own.last + 1, log.time.size() - 1);
    const auto hinge = [&](const Peak& peak) {
      return peak.frame < 0 ? "" : dof_name(log.model, static_cast<int>(peak.column));
    };
    const auto time = [&](const Peak& peak) { return peak.frame < 0 ? nan : log.time[peak.frame]; };
    const auto gained = [&](const char* name) {
      const std::vector<double> sum = log.h5.doubles(std::string("/diagnostics/") + name);
      return sum[last] - sum[own.first];
    };
    const Peak f = peak_of(thigmotaxis, root_dofs, first, last);
    const Peak u = peak_of(active, root_dofs, first, last);
    const Peak m = muscled ? peak_of(activation, 0, first, last) : Peak{};
    const bool loaded = m.frame >= 0;
    table.add({std::string(phase.name), log.time[own.first], log.time[last], f.size, hinge(f),
               time(f), u.size, hinge(u), time(u),
               loaded ? log.model.muscles[static_cast<std::size_t>(m.column)].name : "",
               loaded ? m.size : nan, time(m), std::string(loaded ? "guess" : ""),
               effort_of(log, thigmotaxis, first, last), gained("work_tip"), gained("work_active"),
               gained("work_thigmotaxis"), gained("dissipated")});
  }
  return table;
}

ExportTable summary_table(const LogContents& log, const SweptSkin& swept, bool si) {
  const Specimen& animal = log.resolved.specimen;
  std::vector<ExportColumn> columns{{"log", none, "the file"},
                                    {"scene", none, "its title"},
                                    {"specimen", none, "the animal"},
                                    {"status", none, "complete, running, or failed and why"},
                                    {"bodies", none, "rigid bodies of the chain"},
                                    {"length", centimetre, "of the animal"},
                                    {"mass", gram, "of the animal"},
                                    {"step", second, "h, of the integration"}};
  std::vector<ExportTable::Cell> cells{std::filesystem::path(log.h5.file()).filename().string(),
                                       log.resolved.scene.title,
                                       animal.name,
                                       log.h5.root_text("status"),
                                       std::int64_t{log.model.body_count()},
                                       animal.length,
                                       animal.mass,
                                       log.resolved.scene.time.step};
  const RunSummary run = judged_log(log).summary("", "");
  for (const RunFigure& figure : run_figures()) {
    columns.push_back({figure.name, figure.unit, figure.meaning});
    cells.push_back(std::visit([&](auto of) { return ExportTable::Cell(run.*of); }, figure.value));
  }
  columns.push_back({"swept", area, "skin that the knot swept, of skin.csv"});
  columns.push_back({"swept_percent", none, "of all skin, %"});
  cells.insert(cells.end(), {swept.swept(), 100 * swept.swept() / swept.all()});
  ExportTable table("summary.csv", std::move(columns), si);
  table.add(cells);
  return table;
}

}  // namespace hagfish
