#include <cmath>
#include <filesystem>
#include <limits>

#include "core/chain/skin_fold.hpp"
#include "core/knot/knot.hpp"
#include "core/scene/phase.hpp"
#include "experiments/audit/audit_knot.hpp"
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

/// The largest skin_fold() at frames of the held knot, also of logs from before they had one.
double largest_fold(const LogContents& log) {
  double most = 0;
  Kinematics kin;
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    if (!holds_knot(static_cast<Phase>(log.phase[f]))) continue;
    update_positions(log.model, log.q.row(static_cast<Eigen::Index>(f)), kin);
    most = std::max(most, skin_fold(log.model, kin));
  }
  return most;
}

/// Time that was simulated, s: steps go on behind the last frame, where the log has them.
double simulated(const LogContents& log) {
  if (!log.h5.has("/steps/time")) return log.time[log.time.size() - 1] - log.time[0];
  return static_cast<double>(log.h5.shape("/steps/time").at(0)) * log.resolved.scene.time.step;
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

std::string knot_at(const LogContents& log, std::size_t frame) {
  return knot_name({static_cast<int>(log.h5.integers("/knot/determinant")[frame]),
                    static_cast<int>(log.h5.integers("/knot/v2")[frame])});
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
       {"dissipated", energy, "lost to water drag and joint damping, in this phase"}},
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
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Scene& scene = log.resolved.scene;
  const Specimen& animal = log.resolved.specimen;
  const std::size_t end = log.time.size() - 1;
  const Stretch tighten = stretch_of(log, Phase::tighten), slide = stretch_of(log, Phase::slide),
                release = stretch_of(log, Phase::release), free = stretch_of(log, Phase::free);
  const Slide slid = slides_of(log).slide();
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
       {"duration", second, "simulated; of a log of frames, up to the last one"},
       {"knot", none,
        "type as tightening or the slide begins, or at the end where it comes to neither"},
       {"tighten_from", second, "start of tightening"},
       {"slide_from", second, "start of the slide"},
       {"release_from", second, "when the head was let go"},
       {"free_from", second, "when the knot was gone"},
       {"slide_distance", centimetre, "way of the knot's head end while it slides, to the head"},
       {"slide_speed", speed, "that way over its time"},
       {"tail_distance", centimetre, "way of the knot's tail end meanwhile"},
       {"taper_asks", centimetre, "way that the tail end of a knot as tight would come by"},
       {"curvature_travel", centimetre, "way of the body's curvature meanwhile"},
       {"curvature_correlation", none, "of curvature before and after, the least of four quarters"},
       {"both_ends_percent", none, "share by which this is a slide of both ends, %"},
       {"slide", none, "what this is by name"},
       {"sliding_force", force,
        "sum of the four multipliers of Eq. 6: median over the slide of means from frame to frame"},
       {"largest_thigmotaxis", torque, "f_thigmo of any hinge, mean from frame to frame"},
       {"largest_active", torque, "torque of the muscles at any hinge, likewise"},
       {"largest_torque", torque,
        "of both together, of any hinge while the knot slides or pulls, likewise"},
       {"penetration", centimetre, "deepest overlap of skins at any step up to the last frame"},
       {"skin_fold", none,
        "largest radius of the skin over radius of curvature while the knot is held, across one "
        "diameter: above 1 the skin inside of a bend folds into itself"},
       {"limit_violation", radian, "furthest past a joint limit at any step up to the last frame"},
       {"work_tip", energy, "of the scripted force on the tail, in all"},
       {"work_active", energy, "of the muscles, in all"},
       {"work_thigmotaxis", energy, "of f_thigmo, in all"},
       {"dissipated", energy, "lost to water drag and joint damping, in all"},
       {"swept", area, "skin that the knot swept, of skin.csv"},
       {"swept_percent", none, "of all skin, %"}},
      si);
  table.add({std::filesystem::path(log.h5.file()).filename().string(),
             scene.title,
             animal.name,
             log.h5.root_text("status"),
             std::int64_t{log.model.body_count()},
             animal.length,
             animal.mass,
             scene.time.step,
             simulated(log),
             knot_at(log, tighten.reached ? tighten.first
                          : slide.reached ? slide.first
                                          : end),
             from(tighten),
             from(slide),
             from(release),
             from(free),
             slid.leading_way,
             lasted > 0 ? slid.leading_way / lasted : nan,
             slid.trailing_way,
             slid.taper_asks,
             slid.travel,
             slid.correlation,
             100 * slid.share(),
             slide_name(slid),
             sliding_force(log, slide),
             largest(log.h5.rows("/mean/forces/thigmotaxis")),
             largest(log.h5.rows("/mean/forces/active")),
             largest_muscle_torque(log),
             largest(log.h5.doubles("/diagnostics/penetration")),
             largest_fold(log),
             largest(log.h5.doubles("/diagnostics/limit_violation")),
             at_end("work_tip"),
             at_end("work_active"),
             at_end("work_thigmotaxis"),
             at_end("dissipated"),
             swept.swept(),
             100 * swept.swept() / swept.all()});
  return table;
}

}  // namespace hagfish
