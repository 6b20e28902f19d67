#include "experiments/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/knot.hpp"
#include "core/log_writer.hpp"
#include "core/simulation.hpp"

namespace hagfish {
namespace {

constexpr double degree = std::numbers::pi / 180;

double largest(const std::vector<double>& values) {
  double worst = 0;
  for (const double value : values) {
    // A figure that is no number is as bad as can be.
    worst = std::isnan(value) ? INFINITY : std::max(worst, value);
  }
  return worst;
}

Finding bounded(const std::string& name, double value, double bound, const std::string& unit) {
  return {name, value <= bound, fmt::format("{:.3g} {} (at most {:g})", value, unit, bound)};
}

bool in_knot(std::int64_t phase) {
  return phase >= static_cast<int>(Phase::tighten) && phase < static_cast<int>(Phase::release);
}

Finding status(const LogContents& log) {
  const std::string text = log.h5.root_text("status");
  return {"status", text == "complete", text};
}

/// Knot types recomputed from the logged positions.
std::vector<Finding> topology(const LogContents& log) {
  const Scene& scene = log.resolved.scene;
  const Hdf5Reader::Rows position = log.h5.rows("/trajectory/position");
  std::vector<std::string> type(log.time.size());
  for (std::size_t f = 0; f < type.size(); ++f) {
    const Eigen::VectorXd row = position.row(static_cast<Eigen::Index>(f));
    type[f] = knot_name(
        knot_type(row.reshaped(3, row.size() / 3), scene.knot.votes, scene.knot.seed).type);
  }
  if (scene.expect.knot.empty()) {
    return {};
  }
  std::size_t held = 0;
  std::size_t frames = 0;
  std::string lost;
  for (std::size_t f = 0; f < type.size(); ++f) {
    if (in_knot(log.phase[f])) {
      ++frames;
      held += type[f] == scene.expect.knot ? 1 : 0;
      if (lost.empty() && type[f] != scene.expect.knot) {
        lost = fmt::format(", first {} at {:.3f} s", type[f], log.time[f]);
      }
    }
  }
  std::vector<Finding> findings;
  findings.push_back({"knot held", frames > 0 && held == frames,
                      fmt::format("{} at {} of {} frames from tightening to release{}",
                                  scene.expect.knot, held, frames, lost)});
  const bool ended = log.phase.back() == static_cast<int>(Phase::free);
  findings.push_back({"unknot at start", type.front() == "0_1", type.front()});
  findings.push_back({"unknot at end", ended && type.back() == "0_1",
                      type.back() + (ended ? "" : ", but the run ended before the knot was off")});
  return findings;
}

std::vector<Finding> constraints(const LogContents& log) {
  const ExpectSettings& expect = log.resolved.scene.expect;
  const Model model = make_hagfish(log.resolved.specimen, log.resolved.scene);
  double violation = largest(log.h5.doubles("/steps/limit_violation"));
  double penetration = largest(log.h5.doubles("/steps/penetration"));
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    const State state{log.q.row(f), log.qdot.row(f)};
    const Situation situation = observe(model, state, log.resolved.scene);
    violation = std::max(violation, situation.limit_violation);
    penetration = std::max(penetration, situation.penetration);
  }
  return {bounded("penetration", penetration, expect.penetration, "cm, every step"),
          bounded("limits", violation / degree, expect.limit_violation / degree, "deg, every step"),
          bounded("head drift", largest(log.h5.doubles("/steps/head_drift")), expect.head_drift,
                  "cm, every step"),
          bounded("KKT residual", largest(log.h5.doubles("/steps/kkt")), expect.kkt,
                  "scaled, every step")};
}

/// |H (q̇_next - q̇*) - h Σ f| of each frame over its largest term, from the logged numbers alone.
Finding force_balance(const LogContents& log) {
  const Scene& scene = log.resolved.scene;
  const Model model = make_hagfish(log.resolved.specimen, scene);
  const double h = scene.time.step;
  Hdf5Reader::Rows sum = log.h5.rows("/forces/thigmotaxis");
  for (const char* block : {"contact", "limit", "head", "wall"}) {
    sum += log.h5.rows(std::string("/forces/") + block);
  }
  const Hdf5Reader::Rows tip = log.h5.rows("/forces/tip");
  double worst = 0;
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    const State state{log.q.row(f), log.qdot.row(f)};
    const Kinematics kin = kinematics(model, state);
    const StepSystem system = step_system(model, state, kin, {tip.row(f).transpose(), 0}, h);
    const Eigen::VectorXd given =
        generalised_force(model, kin, system.wrench) + system.joint + h * sum.row(f).transpose();
    const Eigen::VectorXd taken = multiply(model, kin, system.op, log.qdot_next.row(f));
    const double scale = std::max(given.lpNorm<Eigen::Infinity>(), taken.lpNorm<Eigen::Infinity>());
    if (scale > 0) {
      worst = std::max(worst, (given - taken).lpNorm<Eigen::Infinity>() / scale);
    }
  }
  return bounded("force balance", worst, log.resolved.scene.expect.force_balance,
                 "of scale, H(q̇ - q̇*) - h Σ f recomputed at every frame");
}

/// f_thigmo at dofs of bodies tailward of the last contact's spline points.
Finding thigmotaxis_extent(const LogContents& log) {
  const Model model = make_hagfish(log.resolved.specimen, log.resolved.scene);
  const Hdf5Reader::Rows force = log.h5.rows("/forces/thigmotaxis");
  const Hdf5Reader::Rows body_b = log.h5.rows("/thigmotaxis/body_b");
  double beyond = 0;
  for (Eigen::Index f = 0; f < force.rows(); ++f) {
    // A spline point loads bodies up to two past the segment that it is on.
    const int last = static_cast<int>(body_b.row(f).maxCoeff()) + 2;
    for (int b = last + 1; body_b(f, 1) >= 0 && b < model.body_count(); ++b) {
      const Body& body = model.bodies[b];
      if (body.dofs > 0) {
        beyond = std::max(
            beyond, force.row(f).segment(body.first_dof, body.dofs).lpNorm<Eigen::Infinity>());
      }
    }
  }
  return bounded("f_thigmo past the knot", beyond, 0, "dyn cm");
}

/// The ledger's imbalance, over the energy that has passed through it.
Finding energy(const LogContents& log) {
  const auto get = [&](const char* name) {
    const std::vector<double> v = log.h5.doubles(std::string("/diagnostics/") + name);
    return Eigen::ArrayXd(Eigen::Map<const Eigen::ArrayXd>(v.data(), v.size()));
  };
  const Eigen::ArrayXd energy =
      get("kinetic_energy") + get("elastic_energy") + get("gravity_energy");
  const Eigen::ArrayXd works = get("work_tip") + get("work_thigmotaxis") + get("work_contact") +
                               get("work_limit") + get("work_head") + get("work_wall");
  const Eigen::ArrayXd error = get("integrator_error");
  const Eigen::ArrayXd dissipated = get("dissipated");
  const double worst = (energy - energy[0] - works + dissipated - error).abs().maxCoeff();
  const double passed = std::max(dissipated.abs().maxCoeff(), works.abs().maxCoeff());
  const double relative = passed > 0 ? worst / passed : worst;
  Finding finding = bounded("energy ledger", relative, log.resolved.scene.expect.energy,
                            "of the energy that passed");
  finding.text += fmt::format("; {:.0f} erg worked, {:.0f} dissipated, {:.0f} integrator's own",
                              works[works.size() - 1], dissipated[dissipated.size() - 1],
                              error[error.size() - 1]);
  return finding;
}

std::vector<Finding> sliding(const LogContents& log) {
  const ExpectSettings& expect = log.resolved.scene.expect;
  if (expect.knot.empty()) {
    return {};
  }
  const std::vector<double> head_end = log.h5.doubles("/knot/head_end");
  double first = NAN;
  double last = NAN;
  for (std::size_t f = 0; f < head_end.size(); ++f) {
    if (log.phase[f] == static_cast<int>(Phase::slide) && !std::isnan(head_end[f])) {
      first = std::isnan(first) ? head_end[f] : first;
      last = head_end[f];
    }
  }
  // Steps of a phase lie between its frames' first and last step.
  const std::vector<std::int64_t> step = log.h5.integers("/trajectory/step");
  const std::vector<std::int64_t> eq6 = log.h5.integers("/steps/eq6");
  std::int64_t met = 0;
  std::int64_t rows = 0;
  for (std::size_t f = 0; f + 1 < step.size(); ++f) {
    if (log.phase[f] != static_cast<int>(Phase::slide)) {
      continue;
    }
    for (std::int64_t k = step[f]; k < step[f + 1]; ++k) {
      rows += 1;
      met += eq6.at(k - step.front()) == 1 ? 1 : 0;
    }
  }
  const double travel = first - last;
  const double share = rows > 0 ? static_cast<double>(met) / static_cast<double>(rows) : 0;
  return {{"slide", travel >= expect.slide_distance,
           fmt::format("head end of the knot moved {:.2f} cm headward (at least {:g})", travel,
                       expect.slide_distance)},
          {"Eq. 6", share >= expect.speed_share,
           fmt::format("met without slack on {:.2f} % of {} sliding steps (at least {:g} %)",
                       100 * share, rows, 100 * expect.speed_share)}};
}

}  // namespace

LogContents::LogContents(const std::string& file) : h5(file) {
  if (h5.root_text("format") != log_format) {
    throw FileError(file + ": not a " + log_format + " file");
  }
  if (h5.root_int("format_version") != log_format_version) {
    throw FileError(fmt::format("{}: format version {}, this program reads {}", file,
                                h5.root_int("format_version"), log_format_version));
  }
  resolved = read_scene_text(h5.root_text("scene"), file + ": scene");
  time = h5.doubles("/trajectory/time");
  phase = h5.integers("/trajectory/phase");
  q = h5.rows("/trajectory/q");
  qdot = h5.rows("/trajectory/qdot");
  qdot_next = h5.rows("/trajectory/qdot_next");
  if (time.empty()) {
    throw FileError(file + ": holds no frames");
  }
}

std::vector<Finding> audit(const std::string& file) {
  const LogContents log(file);
  std::vector<Finding> findings{status(log)};
  const auto append = [&findings](std::vector<Finding> more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  append(topology(log));
  append(sliding(log));
  append(constraints(log));
  findings.push_back(force_balance(log));
  findings.push_back(thigmotaxis_extent(log));
  findings.push_back(energy(log));
  return findings;
}

}  // namespace hagfish
