#include "experiments/audit/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/log/frame_rows.hpp"
#include "core/log/log_writer.hpp"
#include "core/log/logged_run.hpp"
#include "core/run/momentum.hpp"
#include "core/run/simulation.hpp"
#include "experiments/audit/audit_activation.hpp"
#include "experiments/audit/audit_forces.hpp"
#include "experiments/audit/audit_forward_inverse.hpp"
#include "experiments/audit/audit_frames.hpp"
#include "experiments/audit/audit_knot.hpp"
#include "experiments/audit/audit_muscles.hpp"
#include "experiments/audit/audit_pull.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {
namespace {

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

/// What passes through the body, from means and from the tip's force at frames.
Passed passed_through(const LogContents& log) {
  Passed passed(log.model, log.resolved.scene.time.step);
  Hdf5Reader::Rows tip = log.h5.rows("/forces/tip");
  const Hdf5Reader::Rows head = log.h5.rows("/mean/forces/head");
  const Hdf5Reader::Rows wall = log.h5.rows("/mean/forces/wall");
  if (log.has_end()) tip.row(log.begun) = tip.row(log.begun - 1);  // up to the end
  for (Eigen::Index f = 1; f < tip.rows(); ++f) {
    const Eigen::Vector3d force = 0.5 * (tip.row(f) + tip.row(f - 1));
    passed.see(log.time[f] - log.time[f - 1], force, head.row(f), wall.row(f));
  }
  return passed;
}

Finding energy_gain(const LogContents& log, const Passed& passed) {
  const Eigen::ArrayXd energy = mechanical_energy(log);
  const Eigen::ArrayXd works = diagnostic(log, "work_tip") + diagnostic(log, "work_active") +
                               diagnostic(log, "work_thigmotaxis");
  const Eigen::ArrayXd put_in = since_start(works);
  const Eigen::ArrayXd gravity = diagnostic(log, "gravity_energy");
  const double rounding = totals_rounding * std::max({works.abs().maxCoeff(),
                                                      gravity.abs().maxCoeff(), passed.energy()});
  EnergyGain gain(energy[0], gravity[0]);
  for (Eigen::Index f = 0; f < energy.size(); ++f) {
    gain.see(energy[f] - rounding, put_in[f], gravity[f]);
  }
  return judged_over(energy_gain_criterion(log.resolved.scene.expect, gain.largest()));
}

/// The ledger's imbalance, and what the integrator takes, over the energy that has passed through
/// it.
std::vector<Finding> energy(const LogContents& log, const Passed& through) {
  double largest_total = through.energy();
  const auto get = [&](const char* name) {
    const Eigen::ArrayXd total = diagnostic(log, name);
    largest_total = std::max(largest_total, total.abs().maxCoeff());
    return since_start(total);
  };
  const Eigen::ArrayXd energy = since_start(mechanical_energy(log));
  Eigen::ArrayXd works = Eigen::ArrayXd::Zero(energy.size());
  double passed = through.energy();  // works of forces that hold each other cancel
  for (const char* name : {"work_tip", "work_active", "work_thigmotaxis", "work_contact",
                           "work_limit", "work_head", "work_wall"}) {
    const Eigen::ArrayXd work = get(name);
    works += work;
    passed = std::max(passed, work.abs().maxCoeff());
  }
  const Eigen::ArrayXd error = get("integrator_error");
  const Eigen::ArrayXd dissipated = get("dissipated");
  const Eigen::ArrayXd impacts = get("impact_loss");
  const double worst = largest((energy - works + dissipated + impacts - error).abs().eval());
  const double had =
      (diagnostic(log, "kinetic_energy") + diagnostic(log, "elastic_energy")).maxCoeff();
  passed = std::max({passed, works.abs().maxCoeff(), dissipated.abs().maxCoeff()});
  largest_total = std::max(largest_total, mechanical_energy(log).abs().maxCoeff());
  const double relative = share_of(worst, passed, largest_total);
  Finding finding = judged_over(
      {"energy ledger", relative, log.resolved.scene.expect.energy, "of the energy that passed"});
  finding.text += fmt::format(
      "; {:.0f} erg worked, {:.0f} dissipated, {:.0f} lost at impacts, {:.0f} integrator's own",
      works[works.size() - 1], dissipated[dissipated.size() - 1], impacts[impacts.size() - 1],
      error[error.size() - 1]);
  const double loss = share_of(IntegratorLoss::of(error), std::max(passed, had), largest_total);
  return {finding, judged_over(energy_loss_criterion(log.resolved.scene.expect, loss),
                               "by the integrator, without impacts")};
}

/// One of the two momentum ledgers, linear or angular: its columns, since the log began.
struct MomentumColumns {
  MomentumColumns(const LogContents& log, const std::string& angular)
      : momentum(get(log, angular + "momentum")),
        drag(total(log, angular + "impulse_drag")),
        outside(total(log, angular + "impulse_outside")),
        integrator(total(log, "integrator_" + angular + "momentum")),
        given_back(total(log, angular + "momentum_given_back")) {}

  static Hdf5Reader::Rows get(const LogContents& log, const std::string& name) {
    return log.h5.rows("/diagnostics/" + name);
  }
  /// Since the log began.
  Hdf5Reader::Rows total(const LogContents& log, const std::string& name) {
    const Hdf5Reader::Rows rows = get(log, name);
    largest_total = worse(largest_total, most(rows));
    return since_start(rows);
  }
  static double most(const Hdf5Reader::Rows& rows) {
    return rows.allFinite() ? rows.cwiseAbs().maxCoeff() : INFINITY;
  }
  /// `through`: the sum of the sizes of forces.
  double passed(double through) const {
    return std::max({most(momentum), most(drag), most(outside), most(integrator), through});
  }

  double largest_total = 0;  ///< of any
  Hdf5Reader::Rows momentum, drag, outside, integrator, given_back;
};

Finding momentum_ledger(const LogContents& log, const std::string& name, const char* unit,
                        const MomentumColumns& of, double through) {
  const auto most = &MomentumColumns::most;
  const double off =
      most(since_start(of.momentum) - of.drag - of.outside - of.integrator - of.given_back);
  const double relative = share_of(off, of.passed(through), of.largest_total);
  Finding finding = judged_over(
      {name, relative, log.resolved.scene.expect.energy, "of the momentum that passed"});
  finding.text += fmt::format(
      "; at most {:.3g} {} by drag, {:.3g} from outside, {:.3g} the integrator's own, {:.3g} given "
      "back",
      most(of.drag), unit, most(of.outside), most(of.integrator), most(of.given_back));
  return finding;
}

/// Whether anything is given back between frames at which the head is held.
bool given_while_held(const LogContents& log, const MomentumColumns& of) {
  for (Eigen::Index f = 1; f < of.given_back.rows(); ++f) {
    const bool grew = !(of.given_back.row(f) - of.given_back.row(f - 1)).isZero(0);
    if (grew && log.clamped(f - 1) && log.clamped(f)) return true;
  }
  return false;
}

/// What the integrator makes of a momentum, and does not give back, from frames to frames at which
/// nothing holds the head, over the most that passed and that the body's parts have about the
/// centre of mass: `scale` but for drag. What all of the body has depends on the observer.
double made_while_free(const LogContents& log, const MomentumColumns& of, double scale) {
  Eigen::RowVector3d made = Eigen::RowVector3d::Zero();
  double most = 0;
  for (Eigen::Index f = 1; f < of.momentum.rows(); ++f) {
    if (log.clamped(f - 1) || log.clamped(f)) {
      made.setZero();
      continue;
    }
    made += of.integrator.row(f) - of.integrator.row(f - 1) + of.given_back.row(f) -
            of.given_back.row(f - 1);
    most = worse(most, made.norm());
  }
  return share_of(most, std::max(scale, MomentumColumns::most(of.drag)), of.largest_total);
}

/// What happens to momentum; where nothing holds or pulls the animal, that nothing does.
std::vector<Finding> momentum(const LogContents& log, const Passed& passed) {
  MomentumColumns linear(log, "");
  MomentumColumns angular(log, "angular_");
  // As GuardSettings::momentum_gain: with the largest kinetic energy.
  const double mass = passed.mass();
  const Eigen::ArrayXd kinetic = diagnostic(log, "kinetic_energy");
  const Eigen::ArrayXd whole = 0.5 / mass * linear.momentum.rowwise().squaredNorm().array();
  const double through = passed.momentum();
  const double parts = std::sqrt(2 * mass * (kinetic - whole).cwiseMax(0).maxCoeff());
  // A body that falls has parts that are large where all of it is not.
  const double all = std::max(through, std::sqrt(2 * mass * kinetic.maxCoeff()));
  linear.largest_total = worse(linear.largest_total, all);
  angular.largest_total = worse(angular.largest_total, all * passed.arm());
  std::vector<Finding> findings{momentum_ledger(log, "momentum ledger", "dyn s", linear, through),
                                momentum_ledger(log, "angular momentum ledger", "dyn cm s", angular,
                                                passed.angular_momentum())};
  const int held =
      (given_while_held(log, linear) ? 1 : 0) + (given_while_held(log, angular) ? 1 : 0);
  findings.push_back(judged({"given back", static_cast<double>(held), 0, "ledgers"},
                            held == 0 ? "nothing while the head is held"
                                      : "while the head is held: /diagnostics/momentum_given_back "
                                        "or angular_momentum_given_back"));
  const Scene& scene = log.resolved.scene;
  bool ever_free = false;
  for (Eigen::Index f = 1; f < log.q.rows(); ++f) {
    ever_free = ever_free || !(log.clamped(f - 1) || log.clamped(f));
  }
  if (ever_free) {
    const double scale = std::max(parts, through);
    const double share = worse(made_while_free(log, linear, scale),
                               made_while_free(log, angular, scale * passed.arm()));
    findings.push_back(
        judged_over({"free momentum", share, scene.expect.momentum, "of the momentum that passed"},
                    "made by the integrator while nothing held the head"));
  }
  using Kind = ScriptSettings::Kind;
  const bool free = !log.own_law() && !scene.clamp_head && log.model.obstacles.empty() &&
                    scene.gravity.isZero(0) &&
                    (scene.script.kind == Kind::none || scene.script.kind == Kind::curvature);
  if (free) {
    findings.push_back(judged_over(
        {"nothing outside",
         std::max(MomentumColumns::most(linear.outside), MomentumColumns::most(angular.outside)), 0,
         "dyn s, dyn cm s"},
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

std::vector<Finding> audit(const std::string& file) { return audit(LogContents(file)); }

std::vector<Finding> audit(const LogContents& log) {
  require_own_steps(log.h5);
  FrameAudit frames(log);
  ForceAudit forces(log);
  MuscleAudit muscles(log);
  ActivationAudit activations(log);
  ForwardInverseAudit forward_inverse(log);
  const Passed passed = passed_through(log);
  std::vector<SeenKnot> knots;
  double deepest = 0;
  double furthest = 0;
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    const AuditedFrame frame(log, f);
    knots.push_back(see_knot(log, frame));
    frames.see(frame, knots.back().vote);
    forces.see(frame);
    activations.see(frame);
    if (frame.begins_step) {
      muscles.see(frame);
      forward_inverse.see(frame);
    }
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
  append(forces.findings());
  append(muscles.findings());
  append(activations.findings());
  append(audit_pull(log));
  findings.push_back(forward_inverse.finding());
  append(energy(log, passed));
  findings.push_back(energy_gain(log, passed));
  append(momentum(log, passed));
  return findings;
}

}  // namespace hagfish
