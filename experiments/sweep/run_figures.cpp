#include "experiments/sweep/run_figures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/chain/skin_fold.hpp"
#include "core/input/toml_range.hpp"
#include "core/log/end_of_run.hpp"
#include "core/log/log_writer.hpp"
#include "core/run/laws.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {
namespace {

constexpr double nan = RunSummary::none;

double total(const EnergyLedger& ledger) {
  return ledger.kinetic + ledger.elastic + ledger.gravity;
}

double put_in(const EnergyLedger& ledger) {
  return ledger.work_tip + ledger.work_active + ledger.work[RowKind::thigmotaxis];
}

double balance(const EnergyLedger& ledger) {
  return total(ledger) - ledger.works() + ledger.dissipated + ledger.impacts -
         ledger.integrator_error();
}

Eigen::Vector3d balance(const MomentumLedger& ledger) {
  return (ledger.momentum - ledger.drag - ledger.outside - ledger.integrator - ledger.given_back)
      .linear;
}

double most(const Eigen::Vector3d& v) { return v.allFinite() ? v.cwiseAbs().maxCoeff() : INFINITY; }

/// Largest of the hinges; not of the first frame, whose means are nan.
double largest_hinge(const Eigen::VectorXd& force) {
  const double largest = force.tail(force.size() - root_dofs).cwiseAbs().maxCoeff();
  return std::isnan(largest) ? 0 : largest;
}

/// None of a body that is past having a type: one that touches itself, or is too tangled.
std::string type_name(const Eigen::Matrix3Xd& centreline, const KnotSettings& settings) {
  try {
    return knot_name(knot_type(centreline, settings).type);
  } catch (const std::domain_error&) {
    return "";
  } catch (const std::overflow_error&) {
    return "";
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> RunSummary::fields() const {
  const auto number = [](double value) {
    return std::isfinite(value) ? shortest(value + 0.0) : std::string();  // no -0
  };
  return {{"outcome", outcome},
          {"unmet", unmet},
          {"message", message},
          {"knot", knot},
          {"slide", slide},
          {"duration_s", number(duration)},
          {"tighten_from_s", number(tighten_from)},
          {"slide_from_s", number(slide_from)},
          {"release_from_s", number(release_from)},
          {"free_from_s", number(free_from)},
          {"slide_distance_cm", number(slide_distance)},
          {"slide_speed_cm_per_s", number(slide_speed)},
          {"tail_distance_cm", number(tail_distance)},
          {"taper_asks_cm", number(taper_asks)},
          {"curvature_travel_cm", number(curvature_travel)},
          {"curvature_correlation", number(curvature_correlation)},
          {"both_ends_percent", number(both_ends)},
          {"sliding_force_dyn", number(sliding_force)},
          {"largest_thigmotaxis_dyn_cm", number(largest_thigmotaxis)},
          {"largest_active_dyn_cm", number(largest_active)},
          {"largest_torque_dyn_cm", number(largest_torque)},
          {"pull_N", number(pull)},
          {"penetration_cm", number(penetration)},
          {"skin_fold", number(skin_fold)},
          {"limit_violation_rad", number(limit_violation)},
          {"head_drift_cm", number(head_drift)},
          {"kkt", number(kkt)},
          {"eq6_percent", number(eq6)},
          {"energy_ledger", number(energy_ledger)},
          {"energy_gain", number(energy_gain)},
          {"energy_loss", number(energy_loss)},
          {"momentum_ledger", number(momentum_ledger)},
          {"work_tip_erg", number(work_tip)},
          {"work_active_erg", number(work_active)},
          {"work_thigmotaxis_erg", number(work_thigmotaxis)},
          {"dissipated_erg", number(dissipated)}};
}

RunFigures::RunFigures(const Model& model, const Scene& scene)
    : model_(model),
      scene_(scene),
      means_(model.nv()),
      stride_(frame_stride(scene.time)),
      slides_(model),
      passed_(model, scene.time.step) {}

void RunFigures::see(const StepRecord& record) {
  const ThigmotaxisRows rows =
      thigmotaxis_rows_of(record.control, record.solution, scene_.time.step);
  const Observation& seen = record.moment.observation;
  ++steps_;
  penetration_ = worse(penetration_, seen.penetration);
  limit_violation_ = worse(limit_violation_, seen.limit_violation);
  head_drift_ = worse(head_drift_, record.head_drift);
  clamped_ = record.control.clamp_head;
  kkt_ = worse(kkt_, std::max(record.solution.kkt.worst(), record.solution.stationarity));
  lost_ = lost_ || !record.controller.lost.empty();
  if (record.step % stride_ == 0) {
    see_frame(record);
  }
  // The step that begins at a frame counts to what follows it.
  means_.take(record, rows);
  const Phase phase = frames_.back().phase;
  if (phase == Phase::slide || phase == Phase::reverse) {
    ++eq6_steps_since_;
    eq6_met_since_ += rows.any && rows.met ? 1 : 0;
  }
}

void RunFigures::see_end(const Simulation& sim) {
  if (frames_.empty()) return;
  const StepRecord end = end_record(model_, time_of(sim, scene_), sim, clamped_);
  penetration_ = worse(penetration_, end.moment.observation.penetration);
  limit_violation_ = worse(limit_violation_, end.moment.observation.limit_violation);
  head_drift_ = worse(head_drift_, end.head_drift);
  see_frame(end);
  ended_ = true;
}

void RunFigures::see_frame(const StepRecord& record) {
  const FrameMeans& mean = means_.close();
  const std::optional<KnotSpan> span = knot_span(record.controller);
  const Phase phase = record.controller.phase;
  if (holds_knot(phase) && held_.empty()) {
    held_ = type_name(record.moment.observation.kin.centre, scene_.knot);
  }
  slides_.see(phase, span, record.moment.state.q);
  if (!frames_.empty()) {
    const Eigen::Vector3d tip =
        record.solution.tip.allFinite() ? record.solution.tip : Eigen::Vector3d::Zero();
    passed_.see(record.time - frames_.back().time, tip, mean.force[RowKind::head],
                mean.force[RowKind::obstacle]);
  }
  frames_.push_back({record.time, phase,
                     std::accumulate(mean.lambda.begin(), mean.lambda.end(), 0.0),
                     pull_of(mean.force[RowKind::head]), mean.force[RowKind::obstacle][0]});
  // What happens between two frames counts to the phase of the first.
  if (frames_.size() > 1 && slides_or_pulls(frames_[frames_.size() - 2].phase)) {
    largest_torque_ = std::max(
        largest_torque_, largest_hinge(mean.active_torque + mean.force[RowKind::thigmotaxis]));
  }
  if (holds_knot(phase)) {
    skin_fold_ = std::max(skin_fold_, skin_fold(model_, record.moment.observation.kin));
  }
  last_centreline_ = record.moment.observation.kin.centre;
  largest_thigmotaxis_ =
      std::max(largest_thigmotaxis_, largest_hinge(mean.force[RowKind::thigmotaxis]));
  largest_active_ = std::max(largest_active_, largest_hinge(mean.active_torque));
  eq6_met_ += std::exchange(eq6_met_since_, 0);
  eq6_steps_ += std::exchange(eq6_steps_since_, 0);
  see_ledgers(record);
}

void RunFigures::see_ledgers(const StepRecord& record) {
  const MomentumLedger& momentum = record.momentum;
  ledger_ = record.ledger;
  if (frames_.size() == 1) {
    gain_ = EnergyGain(total(ledger_), ledger_.gravity);
    first_balance_ = balance(ledger_);
    first_momentum_ = momentum.momentum.linear;
    first_error_ = ledger_.integrator_error();
  }
  for (const double of : {ledger_.works(), ledger_.dissipated, ledger_.impacts, total(ledger_),
                          ledger_.gravity, ledger_.integrator_error(), passed_.energy()}) {
    largest_energy_ = std::max(largest_energy_, std::abs(of));
  }
  gain_.see(total(ledger_) - totals_rounding * largest_energy_, put_in(ledger_), ledger_.gravity);
  imbalance_ = worse(imbalance_, std::abs(balance(ledger_) - first_balance_));
  worked_ = std::max(worked_, std::abs(ledger_.works()));
  dissipated_ = std::max(dissipated_, std::abs(ledger_.dissipated));
  loss_.see(ledger_.integrator_error() - first_error_);
  had_ = std::max(had_, ledger_.kinetic + ledger_.elastic);
  momentum_off_ = worse(momentum_off_, most(balance(momentum) - first_momentum_));
  for (const Momentum* of :
       {&momentum.momentum, &momentum.drag, &momentum.outside, &momentum.integrator}) {
    momentum_passed_ = std::max(momentum_passed_, most(of->linear));
  }
  largest_momentum_ = std::max(largest_momentum_, std::sqrt(2 * passed_.mass() * ledger_.kinetic));
}

RunFigures::Stretch RunFigures::stretch(Phase phase) const {
  Stretch found;
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    if (frames_[f].phase != phase) continue;
    if (!found.reached) found.first = f;
    found.last = f;
    found.reached = true;
  }
  return found;
}

bool RunFigures::reaches(Phase phase) const {
  return phase_order(scene_.time.until) >= phase_order(phase) &&
         phase_order(scene_.start.phase) <= phase_order(phase);
}

RunSummary RunFigures::summary(const std::string& outcome, const std::string& message) const {
  RunSummary run;
  run.outcome = outcome;
  run.message = message;
  if (frames_.empty()) {
    return run;
  }
  const auto from = [&](Phase phase) {
    const Stretch found = stretch(phase);
    return found.reached ? frames_[found.first].time : nan;
  };
  const Stretch sliding = stretch(Phase::slide);
  run.knot = held_.empty() ? type_at_end() : held_;
  run.duration = static_cast<double>(steps_) * scene_.time.step;
  run.tighten_from = from(Phase::tighten);
  run.slide_from = from(Phase::slide);
  run.release_from = from(Phase::release);
  run.free_from = from(Phase::free);
  if (sliding.reached) {
    const Slide slide = slides_.slide();
    const double lasted = frames_[sliding.last].time - frames_[sliding.first].time;
    run.slide_distance = slide.leading_way;
    run.slide_speed = lasted > 0 ? run.slide_distance / lasted : nan;
    run.tail_distance = slide.trailing_way;
    run.taper_asks = slide.taper_asks;
    run.curvature_travel = slide.travel;
    run.curvature_correlation = slide.correlation;
    run.both_ends = 100 * slide.share();
    run.slide = slide_name(slide);
    std::vector<double> sums;
    for (std::size_t f = sliding.first + 1; f <= sliding.last; ++f) sums.push_back(frames_[f].rows);
    run.sliding_force = sums.empty() ? nan : median(sums);
  }
  run.largest_thigmotaxis = largest_thigmotaxis_;
  run.largest_active = largest_active_;
  run.largest_torque = largest_torque_;
  run.penetration = penetration_;
  run.skin_fold = skin_fold_;
  run.limit_violation = limit_violation_;
  run.head_drift = head_drift_;
  run.kkt = kkt_;
  run.eq6 = eq6_criterion(scene_.expect, eq6_met_, eq6_steps_).value;
  const double through = passed_.energy();
  const double momentum = std::max({momentum_passed_, largest_momentum_, passed_.momentum()});
  run.energy_ledger =
      share_of(imbalance_, std::max({worked_, dissipated_, through}), largest_energy_);
  run.energy_gain = gain_.largest();
  run.energy_loss =
      share_of(loss_.largest(), std::max({worked_, dissipated_, had_, through}), largest_energy_);
  run.momentum_ledger =
      share_of(momentum_off_, std::max(momentum_passed_, passed_.momentum()), momentum);
  run.work_tip = ledger_.work_tip;
  run.work_active = ledger_.work_active;
  run.work_thigmotaxis = ledger_.work[RowKind::thigmotaxis];
  run.dissipated = ledger_.dissipated;
  if (const auto judged = pull_criteria(scene_.expect, settled_part(scene_.expect, pull()));
      !judged.empty()) {
    run.pull = judged.front().value;
  }
  run.unmet = fmt::format("{}", fmt::join(unmet(run), "; "));
  return run;
}

std::string RunFigures::type_at_end() const { return type_name(last_centreline_, scene_.knot); }

std::vector<PullMeans> RunFigures::pull() const {
  std::vector<PullMeans> means;
  // The means before the state at the end may be of less time.
  const std::size_t count = frames_.size() - (ended_ ? 1 : 0);
  for (std::size_t f = 1; f < count; ++f) {
    if (frames_[f - 1].phase == Phase::pull && frames_[f].phase == Phase::pull) {
      means.push_back({frames_[f].time, frames_[f].pull, frames_[f].plate});
    }
  }
  return means;
}

std::vector<Criterion> RunFigures::criteria(const RunSummary& run) const {
  const ExpectSettings& expect = scene_.expect;
  std::vector<Criterion> judged = {penetration_criterion(expect, run.penetration),
                                   skin_fold_criterion(expect, run.skin_fold),
                                   limits_criterion(expect, run.limit_violation),
                                   head_drift_criterion(expect, run.head_drift),
                                   kkt_criterion(expect, run.kkt),
                                   {"energy ledger", run.energy_ledger, expect.energy, ""},
                                   energy_gain_criterion(expect, run.energy_gain),
                                   energy_loss_criterion(expect, run.energy_loss),
                                   {"momentum ledger", run.momentum_ledger, expect.energy, ""}};
  const auto append = [&judged](const std::vector<Criterion>& more) {
    judged.insert(judged.end(), more.begin(), more.end());
  };
  if (!expect.knot.empty() && reaches(Phase::slide)) {
    append(slide_criteria(scene_, slides_.slide()));
    const Law& law = law_of(scene_);
    if (law.rows == nullptr || law.rows(scene_, Phase::slide).any) {
      judged.push_back(eq6_criterion(expect, eq6_met_, eq6_steps_));
    }
  }
  if (expect.torque_share > 0) judged.push_back(torque_criterion(scene_, run.largest_torque));
  if (!expect.knot.empty() && reaches(Phase::reverse) &&
      scene_.controller.leave_by == BodyEnd::tail) {
    append(way_back_criteria(scene_, slides_.way_back()));
  }
  return judged;
}

std::vector<std::string> RunFigures::unmet(const RunSummary& run) const {
  std::vector<std::string> names;
  const auto judge = [&names](const std::string& name, bool met) {
    if (!met) names.push_back(name);
  };
  if (!scene_.expect.knot.empty()) {
    if (reaches(Phase::tighten)) {
      judge("knot held",
            !held_.empty() && !lost_ && run.outcome != outcome_name(Outcome::knot_lost));
    }
    if (reaches(Phase::free)) {
      judge("unknot at end", frames_.back().phase == Phase::free && type_at_end() == knot_name({}));
    }
  }
  for (const Criterion& criterion : criteria(run)) judge(criterion.name, criterion.met());
  if (pulls_at_food(scene_)) {
    const auto judged = pull_criteria(scene_.expect, settled_part(scene_.expect, pull()));
    judge("pull", settles(scene_) ? !judged.empty() : !pull().empty());
    if (settles(scene_)) {
      for (const Criterion& criterion : judged) judge(criterion.name, criterion.met());
    }
  }
  return names;
}

}  // namespace hagfish
