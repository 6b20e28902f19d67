#include <cmath>
#include <filesystem>
#include <limits>

#include "core/knot/knot.hpp"
#include "experiments/audit/rebuilt.hpp"
#include "experiments/export/export_tables.hpp"

namespace hagfish {
namespace {

using namespace export_unit;

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

double largest(const Hdf5Reader::Rows& rows) {
  double most = 0;
  for (const double value : rows.rightCols(rows.cols() - root_dofs).reshaped()) {
    if (std::abs(value) > most) most = std::abs(value);  // nan at the first frame
  }
  return most;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, value);
  return most;
}

/// Median over the slide of the sum of the four multipliers of Eq. 6, means from frame to frame,
/// dyn.
double sliding_force(const LogContents& log, const Stretch& slide) {
  const Hdf5Reader::Rows lambda = log.h5.rows("/mean/thigmotaxis/lambda");
  std::vector<double> sums;
  for (std::size_t f = slide.first + 1; slide.reached && f <= slide.last; ++f) {
    sums.push_back(lambda.row(static_cast<Eigen::Index>(f)).sum());
  }
  return sums.empty() ? std::numeric_limits<double>::quiet_NaN() : median(sums);
}

std::string knot_at(const LogContents& log, std::size_t frame) {
  return knot_name({static_cast<int>(log.h5.integers("/knot/determinant")[frame]),
                    static_cast<int>(log.h5.integers("/knot/v2")[frame])});
}

}  // namespace

ExportTable summary_table(const LogContents& log, bool si) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Scene& scene = log.resolved.scene;
  const Specimen& animal = log.resolved.specimen;
  const std::size_t end = log.time.size() - 1;
  const Stretch tighten = stretch_of(log, Phase::tighten), slide = stretch_of(log, Phase::slide),
                release = stretch_of(log, Phase::release), free = stretch_of(log, Phase::free);
  const std::vector<double> head_end = log.h5.doubles("/knot/head_end");
  const double way = slide.reached ? head_end[slide.first] - head_end[slide.last] : nan;
  const double lasted = slide.reached ? log.time[slide.last] - log.time[slide.first] : 0;
  const auto from = [&](const Stretch& stretch) {
    return stretch.reached ? log.time[stretch.first] : nan;
  };
  const auto at_end = [&](const char* name) {
    return log.h5.doubles(std::string("/diagnostics/") + name)[end];
  };
  ExportTable table(
      "summary.csv",
      {{"log", none, "the file"},
       {"scene", none, "its title"},
       {"specimen", none, "the animal"},
       {"status", none, "complete, running, or failed and why"},
       {"bodies", none, "rigid bodies of the chain"},
       {"length", centimetre, "of the animal"},
       {"mass", gram, "of the animal"},
       {"step", second, "h, of the integration"},
       {"duration", second, "simulated"},
       {"knot", none, "type at the start of tightening, or at the end where it never tightened"},
       {"tighten_from", second, "start of tightening"},
       {"slide_from", second, "start of the slide"},
       {"release_from", second, "when the head was let go"},
       {"free_from", second, "when the knot was gone"},
       {"slide_distance", centimetre, "way of the knot's head end while it slides, to the head"},
       {"slide_speed", speed, "that way over its time"},
       {"sliding_force", force,
        "sum of the four multipliers of Eq. 6: median over the slide of means from frame to frame"},
       {"largest_thigmotaxis", torque, "f_thigmo of any hinge, mean from frame to frame"},
       {"largest_active", torque, "torque of the muscles at any hinge, likewise"},
       {"penetration", centimetre, "deepest overlap of skins at any step up to the last frame"},
       {"limit_violation", radian, "furthest past a joint limit at any step up to the last frame"},
       {"work_tip", energy, "of the scripted force on the tail, in all"},
       {"work_active", energy, "of the muscles, in all"},
       {"work_thigmotaxis", energy, "of f_thigmo, in all"},
       {"dissipated", energy, "lost to water drag and joint damping, in all"}},
      si);
  table.add({std::filesystem::path(log.h5.file()).filename().string(),
             scene.title,
             animal.name,
             log.h5.root_text("status"),
             std::int64_t{log.model.body_count()},
             animal.length,
             animal.mass,
             scene.time.step,
             log.time[end] - log.time[0],
             knot_at(log, tighten.reached ? tighten.first : end),
             from(tighten),
             from(slide),
             from(release),
             from(free),
             way,
             lasted > 0 ? way / lasted : nan,
             sliding_force(log, slide),
             largest(log.h5.rows("/mean/forces/thigmotaxis")),
             largest(log.h5.rows("/mean/forces/active")),
             largest(log.h5.doubles("/diagnostics/penetration")),
             largest(log.h5.doubles("/diagnostics/limit_violation")),
             at_end("work_tip"),
             at_end("work_active"),
             at_end("work_thigmotaxis"),
             at_end("dissipated")});
  return table;
}

}  // namespace hagfish
