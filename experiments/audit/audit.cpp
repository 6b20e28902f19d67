#include "experiments/audit/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/log/frame_rows.hpp"
#include "core/log/log_writer.hpp"
#include "core/run/laws.hpp"
#include "core/run/simulation.hpp"
#include "experiments/audit/audit_activation.hpp"
#include "experiments/audit/audit_checkpoints.hpp"
#include "experiments/audit/audit_datasets.hpp"
#include "experiments/audit/audit_forces.hpp"
#include "experiments/audit/audit_forward_inverse.hpp"
#include "experiments/audit/audit_frames.hpp"
#include "experiments/audit/audit_knot.hpp"
#include "experiments/audit/audit_muscles.hpp"
#include "experiments/audit/audit_pull.hpp"
#include "experiments/audit/audit_rates.hpp"
#include "experiments/audit/audit_steps.hpp"

namespace hagfish {
namespace {

/// A spline point loads bodies up to two past the one nearest to it.
constexpr int spline_reach = 2;

double largest(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0, worse);
}

double largest(const Eigen::ArrayXd& values) {
  return std::accumulate(values.begin(), values.end(), 0.0, worse);
}

Finding status(const LogContents& log) {
  const std::string text = log.h5.root_text("status");
  return {"status", text == "complete", text, text, "complete", ""};
}

/// Bounds of the scene; `deepest` and `furthest` are overlap (cm) and angle past a limit (rad) at
/// the frames, observed again.
std::vector<Finding> constraints(const LogContents& log, double deepest, double furthest) {
  const ExpectSettings& expect = log.resolved.scene.expect;
  const double penetration = worse(deepest, largest(log.h5.doubles("/steps/penetration")));
  const double violation = worse(furthest, largest(log.h5.doubles("/steps/limit_violation")));
  const auto every_step = [](const Criterion& criterion) {
    return judged_over(criterion, "every step");
  };
  return {every_step(penetration_criterion(expect, penetration)),
          every_step(limits_criterion(expect, violation)),
          every_step(head_drift_criterion(expect, largest(log.h5.doubles("/steps/head_drift")))),
          every_step(kkt_criterion(expect, largest(log.h5.doubles("/steps/kkt"))))};
}

/// f_thigmo at dofs of bodies tailward of the last contact's spline points.
Finding thigmotaxis_extent(const LogContents& log) {
  const Model& model = log.model;
  const Hdf5Reader::Rows force = log.h5.rows("/forces/thigmotaxis");
  const Hdf5Reader::Rows body_b = log.h5.rows("/thigmotaxis/body_b");
  // Without rows, -1, there must be no force at all.
  Eigen::VectorXd furthest = body_b.rowwise().maxCoeff();
  if (law_of(log.resolved.scene).logs_rows) {
    const std::vector<std::int64_t> frame = log.h5.integers("/eq6/frame");
    const std::vector<double> spline_b = log.h5.doubles("/eq6/spline_b");
    for (std::size_t i = 0; i < frame.size(); ++i) {
      double& most = furthest[frame[i]];
      most = std::max(most, std::floor(spline_b[i] + 0.5));
    }
  }
  double beyond = 0;
  for (Eigen::Index f = 0; f < force.rows(); ++f) {
    const int last = static_cast<int>(furthest[f]);
    for (int b = last < 0 ? 0 : last + spline_reach + 1; b < model.body_count(); ++b) {
      const Body& body = model.bodies[b];
      for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
        beyond = worse(beyond, std::abs(force(f, k)));
      }
    }
  }
  return judged_over({"f_thigmo past the knot", beyond, 0, "dyn cm"});
}

Eigen::ArrayXd diagnostic(const LogContents& log, const char* name) {
  const std::vector<double> v = log.h5.doubles(std::string("/diagnostics/") + name);
  return Eigen::ArrayXd::Map(v.data(), static_cast<Eigen::Index>(v.size()));
}

Eigen::ArrayXd mechanical_energy(const LogContents& log) {
  return diagnostic(log, "kinetic_energy") + diagnostic(log, "elastic_energy") +
         diagnostic(log, "gravity_energy");
}

/// Running totals since the log began: they need not begin at 0, as a branch goes on with those of
/// its run.
template <class Totals>
Totals since_start(const Totals& totals) {
  Totals since = totals;
  for (Eigen::Index f = 0; f < totals.rows(); ++f) since.row(f) -= totals.row(0);
  return since;
}

Finding energy_gain(const LogContents& log) {
  const Eigen::ArrayXd energy = mechanical_energy(log);
  const Eigen::ArrayXd put_in =
      since_start<Eigen::ArrayXd>(diagnostic(log, "work_tip") + diagnostic(log, "work_active") +
                                  diagnostic(log, "work_thigmotaxis"));
  EnergyGain gain(energy[0]);
  for (Eigen::Index f = 0; f < energy.size(); ++f) {
    gain.see(energy[f], put_in[f]);
  }
  return judged_over(energy_gain_criterion(log.resolved.scene.expect, gain.largest()));
}

/// The ledger's imbalance, over the energy that has passed through it.
Finding energy(const LogContents& log) {
  const auto get = [&](const char* name) { return since_start(diagnostic(log, name)); };
  const Eigen::ArrayXd energy = since_start(mechanical_energy(log));
  const Eigen::ArrayXd works = get("work_tip") + get("work_active") + get("work_thigmotaxis") +
                               get("work_contact") + get("work_limit") + get("work_head") +
                               get("work_wall");
  const Eigen::ArrayXd error = get("integrator_error");
  const Eigen::ArrayXd dissipated = get("dissipated");
  const double worst = largest((energy - works + dissipated - error).abs().eval());
  const double passed = std::max(dissipated.abs().maxCoeff(), works.abs().maxCoeff());
  const double relative = passed > 0 ? worst / passed : worst;
  Finding finding = judged_over(
      {"energy ledger", relative, log.resolved.scene.expect.energy, "of the energy that passed"});
  finding.text += fmt::format("; {:.0f} erg worked, {:.0f} dissipated, {:.0f} integrator's own",
                              works[works.size() - 1], dissipated[dissipated.size() - 1],
                              error[error.size() - 1]);
  return finding;
}

/// What happens to linear momentum; where nothing holds or pulls the animal, that nothing does.
std::vector<Finding> momentum(const LogContents& log) {
  const auto get = [&log](const char* name) {
    return log.h5.rows(std::string("/diagnostics/") + name);
  };
  const Hdf5Reader::Rows momentum = get("momentum");
  const Hdf5Reader::Rows drag = since_start(get("impulse_drag"));
  const Hdf5Reader::Rows outside = since_start(get("impulse_outside"));
  const Hdf5Reader::Rows integrator = since_start(get("integrator_momentum"));
  const auto most = [](const Hdf5Reader::Rows& rows) {
    return rows.allFinite() ? rows.cwiseAbs().maxCoeff() : INFINITY;
  };
  const Hdf5Reader::Rows off = since_start(momentum) - drag - outside - integrator;
  const double passed = std::max({most(momentum), most(drag), most(outside)});
  const double relative = passed > 0 ? most(off) / passed : most(off);
  Finding finding = judged_over({"momentum ledger", relative, log.resolved.scene.expect.energy,
                                 "of the momentum that passed"});
  finding.text += fmt::format(
      "; at most {:.3g} dyn s by drag, {:.3g} from outside, {:.3g} the "
      "integrator's own",
      most(drag), most(outside), most(integrator));
  std::vector<Finding> findings{finding};
  const Scene& scene = log.resolved.scene;
  using Kind = ScriptSettings::Kind;
  const bool free = !log.own_law() && !scene.clamp_head && !scene.wall.present &&
                    scene.gravity.isZero(0) &&
                    (scene.script.kind == Kind::none || scene.script.kind == Kind::curvature);
  if (free) {
    findings.push_back(judged_over({"nothing outside", most(outside), 0, "dyn s"},
                                   "no clamp, plate, gravity or tip force"));
  }
  return findings;
}

}  // namespace

Finding judged(const Criterion& criterion, const std::string& text) {
  const auto number = [](double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "";
  };
  return {criterion.name,          criterion.met(),         text,
          number(criterion.value), number(criterion.bound), criterion.unit};
}

Finding judged_over(const Criterion& criterion, const std::string& scope) {
  return judged(criterion,
                fmt::format("{}{}{} (at {} {:g})",
                            std::isfinite(criterion.value)
                                ? fmt::format("{:.3g} {}", criterion.value, criterion.unit)
                                : "no finite number",
                            scope.empty() ? "" : ", ", scope, criterion.at_least ? "least" : "most",
                            criterion.bound));
}

Finding all_of(const std::string& name, std::int64_t count, std::int64_t of,
               const std::string& unit, const std::string& text) {
  const auto number = [of](std::int64_t n) { return of > 0 ? std::to_string(n) : ""; };
  return {name, of > 0 && count == of, text, number(count), number(of), unit};
}

std::vector<Finding> audit(const std::string& file) {
  const LogContents log(file);
  check_datasets(log);
  FrameAudit frames(log);
  ForceAudit forces(log);
  MuscleAudit muscles(log);
  ActivationAudit activations(log);
  RateAudit rates(log);
  ForwardInverseAudit forward_inverse(log);
  std::vector<SeenKnot> knots;
  double deepest = 0;
  double furthest = 0;
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    const AuditedFrame frame(log, f);
    knots.push_back(see_knot(log, frame));
    frames.see(frame, knots.back().vote);
    forces.see(frame);
    muscles.see(frame);
    activations.see(frame);
    rates.see(frame);
    forward_inverse.see(frame);
    deepest = worse(deepest, frame.observation.penetration);
    furthest = worse(furthest, frame.observation.limit_violation);
  }
  std::vector<Finding> findings{status(log)};
  const auto append = [&findings](std::vector<Finding> more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  append(audit_knot(log, knots));
  append(constraints(log, deepest, furthest));
  append(frames.findings());
  append(audit_steps(log));
  append(forces.findings());
  append(muscles.findings());
  append(activations.findings());
  append(audit_pull(log));
  findings.push_back(forward_inverse.finding());
  findings.push_back(thigmotaxis_extent(log));
  findings.push_back(energy(log));
  findings.push_back(energy_gain(log));
  append(momentum(log));
  append(rates.findings());
  findings.push_back(audit_checkpoints(log));
  return findings;
}

}  // namespace hagfish
