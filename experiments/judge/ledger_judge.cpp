#include "experiments/judge/ledger_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

double most(const Eigen::Vector3d& v) { return v.allFinite() ? v.cwiseAbs().maxCoeff() : INFINITY; }

double stored(const EnergyLedger& ledger) {
  return ledger.kinetic + ledger.elastic + ledger.gravity;
}

double put_in(const EnergyLedger& ledger) {
  return ledger.work_tip + ledger.work_active + ledger.work[RowKind::thigmotaxis];
}

/// 0 but for rounding, less what it is at the start.
double balance(const EnergyLedger& ledger) {
  return stored(ledger) - ledger.works() + ledger.dissipated + ledger.impacts -
         ledger.integrator_error();
}

}  // namespace

void MomentumWatch::see(const MomentumLedger& ledger, bool held, bool free) {
  if (!any_) first_ = before_ = ledger;
  any_ = true;
  const auto since_start = [&](Momentum MomentumLedger::*of, double& largest) {
    const Eigen::Vector3d& now = ledger.*of.*part_;
    if (now.allFinite()) total_ = std::max(total_, most(now));
    Eigen::Vector3d since = now - first_.*of.*part_;
    largest = worse(largest, most(since));
    return since;
  };
  const Eigen::Vector3d explained = since_start(&MomentumLedger::drag, drag_) +
                                    since_start(&MomentumLedger::outside, outside_) +
                                    since_start(&MomentumLedger::integrator, integrator_) +
                                    since_start(&MomentumLedger::given_back, given_back_);
  const Eigen::Vector3d& now = ledger.momentum.*part_;
  momentum_ = worse(momentum_, most(now));
  off_ = worse(off_, most(now - first_.momentum.*part_ - explained));
  const Eigen::Vector3d given = ledger.given_back.*part_ - before_.given_back.*part_;
  given_while_held_ = given_while_held_ || (held && !given.isZero(0));
  made_so_far_ += ledger.integrator.*part_ - before_.integrator.*part_ + given;
  if (!free) made_so_far_.setZero();
  made_ = worse(made_, made_so_far_.norm());
  before_ = ledger;
}

double MomentumWatch::off(double through, double largest_total) const {
  return share_of(off_, std::max({momentum_, drag_, outside_, integrator_, through}),
                  worse(total_, largest_total));
}

Finding MomentumWatch::ledger(const char* name, const char* unit, const ExpectSettings& expect,
                              double through, double largest_total) const {
  Finding finding = judged_over(
      {name, off(through, largest_total), expect.energy, "of the momentum that passed"});
  finding.text += fmt::format(
      "; at most {:.3g} {} by drag, {:.3g} from outside, {:.3g} the integrator's own, {:.3g} given "
      "back",
      drag_, unit, outside_, integrator_, given_back_);
  return finding;
}

double MomentumWatch::made_while_free(double scale, double largest_total) const {
  return share_of(made_, std::max(scale, drag_), worse(total_, largest_total));
}

LedgerJudge::LedgerJudge(const Model& model, const Scene& scene)
    : model_(model), scene_(scene), passed_(model, scene.time.step) {}

void LedgerJudge::see(const RunFrame& frame) {
  const EnergyLedger& ledger = frame.energy;
  const Eigen::Vector3d tip = frame.tip.allFinite() ? frame.tip : tip_before_;
  if (!any_) {
    first_ = ledger;
    gain_ = EnergyGain(stored(ledger), ledger.gravity);
    clamped_before_ = frame.clamped;
  } else {
    passed_.see(frame.time - time_before_, 0.5 * (tip_before_ + tip), frame.head, frame.obstacles);
  }
  // Scales: what is no number is told by what they measure.
  const auto passes = [&](double now, double at_start) {
    passed_energy_ = std::max(passed_energy_, std::abs(now - at_start));
    largest_energy_ = std::max(largest_energy_, std::abs(now));
  };
  passes(ledger.work_tip, first_.work_tip);
  passes(ledger.work_active, first_.work_active);
  for (const RowKind kind : row_kinds) passes(ledger.work[kind], first_.work[kind]);
  passes(ledger.works(), first_.works());
  passes(ledger.dissipated, first_.dissipated);
  for (const double of :
       {stored(ledger), ledger.gravity, ledger.impacts, ledger.integrator_error()}) {
    largest_energy_ = std::max(largest_energy_, std::abs(of));
  }
  gain_.see(stored(ledger) - totals_rounding * largest_energy(), put_in(ledger) - put_in(first_),
            ledger.gravity);
  off_ = worse(off_, std::abs(balance(ledger) - balance(first_)));
  loss_.see(ledger.integrator_error() - first_.integrator_error());
  had_ = std::max(had_, ledger.kinetic + ledger.elastic);
  kinetic_ = std::max(kinetic_, ledger.kinetic);
  const double mass = passed_.mass();
  parts_ =
      std::max(parts_, ledger.kinetic - 0.5 / mass * frame.momentum.momentum.linear.squaredNorm());
  const bool held = clamped_before_ && frame.clamped, free = !(clamped_before_ || frame.clamped);
  ever_free_ = ever_free_ || (any_ && free);
  linear_.see(frame.momentum, held, free);
  angular_.see(frame.momentum, held, free);
  any_ = true;
  last_ = ledger;
  time_before_ = frame.time;
  tip_before_ = tip;
  clamped_before_ = frame.clamped;
}

double LedgerJudge::energy_off() const {
  // Works of forces that hold each other cancel.
  return share_of(off_, std::max(passed_energy_, passed_.energy()), largest_energy());
}

double LedgerJudge::energy_loss() const {
  return share_of(loss_.largest(), std::max({passed_energy_, passed_.energy(), had_}),
                  largest_energy());
}

double LedgerJudge::parts() const { return std::sqrt(2 * passed_.mass() * parts_); }

double LedgerJudge::all() const {
  // As momentum_gain of the guards: with the largest kinetic energy. A body that falls has parts
  // that are large where all of it is not.
  return std::max(passed_.momentum(), std::sqrt(2 * passed_.mass() * kinetic_));
}

double LedgerJudge::momentum_off() const { return linear_.off(passed_.momentum(), all()); }

std::vector<Finding> LedgerJudge::momentum() const {
  const double through = passed_.momentum(), arm = passed_.arm();
  std::vector<Finding> findings{
      linear_.ledger("momentum ledger", "dyn s", scene_.expect, through, all()),
      angular_.ledger("angular momentum ledger", "dyn cm s", scene_.expect,
                      passed_.angular_momentum(), all() * arm)};
  const int held = (linear_.given_while_held() ? 1 : 0) + (angular_.given_while_held() ? 1 : 0);
  findings.push_back(judged({"given back", static_cast<double>(held), 0, "ledgers"},
                            held == 0 ? "nothing while the head is held"
                                      : "while the head is held: /diagnostics/momentum_given_back "
                                        "or angular_momentum_given_back"));
  if (ever_free_) {
    // What all of the body has depends on the observer; what its parts have does not.
    const double scale = std::max(parts(), through);
    const double share = worse(linear_.made_while_free(scale, all()),
                               angular_.made_while_free(scale * arm, all() * arm));
    findings.push_back(
        judged_over({"free momentum", share, scene_.expect.momentum, "of the momentum that passed"},
                    "made by the integrator while nothing held the head"));
  }
  using Kind = ScriptSettings::Kind;
  const bool free = scene_.controller.law != own_law && !scene_.clamp_head &&
                    model_.obstacles.empty() && scene_.gravity.isZero(0) &&
                    (scene_.script.kind == Kind::none || scene_.script.kind == Kind::curvature);
  if (free) {
    findings.push_back(judged_over(
        {"nothing outside", std::max(linear_.outside(), angular_.outside()), 0, "dyn s, dyn cm s"},
        "no clamp, plate, gravity or tip force"));
  }
  return findings;
}

std::vector<Finding> LedgerJudge::findings() const {
  Finding energy = judged_over(
      {"energy ledger", energy_off(), scene_.expect.energy, "of the energy that passed"});
  energy.text += fmt::format(
      "; {:.0f} erg worked, {:.0f} dissipated, {:.0f} lost at impacts, {:.0f} integrator's own",
      last_.works() - first_.works(), last_.dissipated - first_.dissipated,
      last_.impacts - first_.impacts, last_.integrator_error() - first_.integrator_error());
  std::vector<Finding> findings{energy,
                                judged_over(energy_loss_criterion(scene_.expect, energy_loss()),
                                            "by the integrator, without impacts"),
                                judged_over(energy_gain_criterion(scene_.expect, energy_gain()))};
  for (Finding& finding : momentum()) findings.push_back(std::move(finding));
  return findings;
}

}  // namespace hagfish
