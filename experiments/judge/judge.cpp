#include "experiments/judge/judge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/control/laws.hpp"
#include "core/input/toml/toml_range.hpp"

namespace hagfish {
namespace {

using namespace figure_unit;

constexpr RunFigure figures[] = {
    {"knot", figure_unit::none,
     "type as tightening or the slide begins, or at the end where it comes to neither",
     &RunSummary::knot},
    {"slide", figure_unit::none, "what the slide is by name: by both ends, or the knot only grows",
     &RunSummary::slide},
    {"duration", second, "simulated; of a log of frames, up to the last one",
     &RunSummary::duration},
    {"tighten_from", second, "start of tightening", &RunSummary::tighten_from},
    {"slide_from", second, "start of the slide", &RunSummary::slide_from},
    {"release_from", second, "when the head was let go", &RunSummary::release_from},
    {"free_from", second, "when the knot was gone", &RunSummary::free_from},
    {"slide_distance", centimetre, "way of the knot's head end while it slides, to the head",
     &RunSummary::slide_distance},
    {"slide_speed", speed, "that way over its time", &RunSummary::slide_speed},
    {"tail_distance", centimetre, "way of the knot's tail end meanwhile",
     &RunSummary::tail_distance},
    {"taper_asks", centimetre, "way that the tail end of a knot as tight would come by",
     &RunSummary::taper_asks},
    {"curvature_travel", centimetre, "way of the body's curvature meanwhile",
     &RunSummary::curvature_travel},
    {"curvature_correlation", figure_unit::none,
     "of curvature before and after, the least of four quarters",
     &RunSummary::curvature_correlation},
    {"both_ends_percent", figure_unit::none, "share by which this is a slide of both ends, %",
     &RunSummary::both_ends},
    {"sliding_force", force,
     "sum of the multipliers of all rows of Eq. 6: median over the slide of means from frame to "
     "frame",
     &RunSummary::sliding_force},
    {"largest_thigmotaxis", torque, "f_thigmo of any hinge, mean from frame to frame",
     &RunSummary::largest_thigmotaxis},
    {"largest_active", torque, "torque of the muscles at any hinge, likewise",
     &RunSummary::largest_active},
    {"largest_torque", torque,
     "own torque and f_thigmo together, of any hinge while the knot slides or pulls, likewise",
     &RunSummary::largest_torque},
    {"pull", newton, "mean pull at food, once settled", &RunSummary::pull},
    {"penetration", centimetre, "deepest overlap of skins at any step", &RunSummary::penetration},
    {"skin_fold", figure_unit::none,
     "largest radius of the skin over radius of curvature while the knot is held, across one "
     "diameter: above 1 the skin inside of a bend folds into itself",
     &RunSummary::skin_fold},
    {"limit_violation", radian, "furthest past a joint limit at any step",
     &RunSummary::limit_violation},
    {"head_drift", centimetre, "largest way of the clamped head at any step",
     &RunSummary::head_drift},
    {"kkt", figure_unit::none, "largest scaled KKT residual of any step", &RunSummary::kkt},
    {"eq6_percent", figure_unit::none, "sliding steps that meet Eq. 6 without slack, %",
     &RunSummary::eq6},
    {"energy_ledger", figure_unit::none,
     "imbalance of the energy ledger, of the energy that passed", &RunSummary::energy_ledger},
    {"energy_gain", figure_unit::none,
     "mechanical energy above what there was and was put in, share of that",
     &RunSummary::energy_gain},
    {"energy_loss", figure_unit::none,
     "energy that the integrator takes, without impacts, of the energy that passed",
     &RunSummary::energy_loss},
    {"momentum_ledger", figure_unit::none,
     "imbalance of the momentum ledger, of the momentum that passed", &RunSummary::momentum_ledger},
    {"work_tip", energy, "of the scripted force on the tail, in all", &RunSummary::work_tip},
    {"work_active", energy, "of the muscles, in all", &RunSummary::work_active},
    {"work_thigmotaxis", energy, "of f_thigmo, in all", &RunSummary::work_thigmotaxis},
    {"dissipated", energy, "lost to water drag, joint damping and damping of flesh, in all",
     &RunSummary::dissipated}};

/// Largest of the hinges; not of the first frame, whose means are nan.
double largest_hinge(const Eigen::VectorXd& force) {
  const double largest = force.tail(force.size() - root_dofs).cwiseAbs().maxCoeff();
  return std::isnan(largest) ? 0 : largest;
}

Finding every_step(const Criterion& criterion) { return judged_over(criterion, "every step"); }

/// The middle one; there must be some.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool slides(Phase phase) { return phase == Phase::slide || phase == Phase::reverse; }

}  // namespace

std::span<const RunFigure> run_figures() { return figures; }

std::vector<std::pair<std::string, std::string>> RunSummary::fields() const {
  std::vector<std::pair<std::string, std::string>> all{
      {"outcome", outcome}, {"unmet", unmet}, {"message", message}};
  for (const RunFigure& figure : figures) {
    const std::string unit = figure.unit.cgs;
    std::string& field =
        all.emplace_back(unit.empty() ? figure.name : figure.name + ("_" + unit), "").second;
    if (const auto* text = std::get_if<std::string RunSummary::*>(&figure.value)) {
      field = this->**text;
    } else if (const double value = this->*std::get<double RunSummary::*>(figure.value);
               std::isfinite(value)) {
      field = shortest(value + 0.0);  // no -0
    }
  }
  return all;
}

Judge::Judge(const Model& model, const Scene& scene, bool branch)
    : model_(model),
      scene_(scene),
      knot_(model, scene, branch),
      ledgers_(model, scene),
      pull_(scene) {}

void Judge::see(const RunFrame& frame) {
  Kinematics kin;
  update_positions(model_, frame.q, kin);
  knot_.see(frame, kin);
  ledgers_.see(frame);
  pull_.see(frame);
  // What happens between two frames counts to the phase of the first.
  if (any_ && slides_or_pulls(phase_)) {
    largest_torque_ = worse(largest_torque_, frame.largest_torque());
  }
  largest_thigmotaxis_ = std::max(largest_thigmotaxis_, largest_hinge(frame.thigmotaxis));
  largest_active_ = std::max(largest_active_, largest_hinge(frame.active));
  if (frame.phase == Phase::slide) rows_.push_back(frame.rows);
  met_ += std::exchange(met_since_, 0);
  sliding_ += std::exchange(sliding_since_, 0);
  if (!any_) first_time_ = frame.time;
  last_time_ = frame.time;
  phase_ = frame.phase;
  ledger_ = frame.energy;
  any_ = true;
}

void Judge::see(const RunStep& step) {
  ++steps_;
  see(step.worst);
  if (!slides(phase_)) return;
  // A law of the run's own is asked at those steps at which it has rows.
  if (step.eq6 != -1 || scene_.controller.law != own_law) ++sliding_since_;
  met_since_ += step.eq6 == 1 ? 1 : 0;
}

void Judge::see(const Worst& worst) {
  worst_.penetration = worse(worst_.penetration, worst.penetration);
  worst_.limit_violation = worse(worst_.limit_violation, worst.limit_violation);
  worst_.head_drift = worse(worst_.head_drift, worst.head_drift);
  worst_.kkt = worse(worst_.kkt, worst.kkt);
}

std::vector<Finding> Judge::of_motion() const {
  const ExpectSettings& expect = scene_.expect;
  std::vector<Finding> findings = knot_.findings();
  if (!expect.knot.empty() && knot_.shows_slide() && expect.torque_share > 0) {
    findings.push_back(judged_over(torque_criterion(scene_, largest_torque_),
                                   "largest of a hinge while the knot slides or pulls"));
  }
  findings.push_back(every_step(penetration_criterion(scene_, worst_.penetration)));
  findings.push_back(every_step(limits_criterion(expect, worst_.limit_violation)));
  findings.push_back(every_step(head_drift_criterion(expect, worst_.head_drift)));
  findings.push_back(knot_.skin());
  return findings;
}

/// Eq. 6 at the steps of both slides; nothing where the law never asks for it.
std::optional<Finding> Judge::eq6() const {
  if (scene_.expect.knot.empty() || !knot_.shows_slide()) return std::nullopt;
  const bool own = scene_.controller.law == own_law;
  const bool asks = own ? sliding_ > 0 : law_of(scene_).asks_for_eq6;
  if (!asks) return std::nullopt;
  const Criterion eq6 = eq6_criterion(scene_.expect, met_, sliding_);
  if (sliding_ == 0) {
    return judged(eq6, fmt::format("no sliding steps (at least {:g} %)", eq6.bound));
  }
  return judged(eq6,
                fmt::format("met without slack on {:.2f} % of {} sliding steps (at least {:g} %)",
                            eq6.value, sliding_, eq6.bound));
}

std::vector<Finding> Judge::findings() const {
  std::vector<Finding> findings = of_motion();
  if (const auto finding = eq6()) findings.push_back(*finding);
  findings.push_back(every_step(kkt_criterion(scene_.expect, worst_.kkt)));
  for (const std::vector<Finding>& more : {pull_.findings(), ledgers_.findings()}) {
    findings.insert(findings.end(), more.begin(), more.end());
  }
  return findings;
}

RunSummary Judge::summary(const std::string& outcome, const std::string& message) const {
  RunSummary run;
  run.outcome = outcome;
  run.message = message;
  if (!any_) return run;
  std::vector<std::string> unmet;
  for (const Finding& finding : findings()) {
    if (!finding.passed) unmet.push_back(finding.name);
  }
  run.unmet = fmt::format("{}", fmt::join(unmet, "; "));
  run.knot = knot_.type();
  run.duration =
      steps_ > 0 ? static_cast<double>(steps_) * scene_.time.step : last_time_ - first_time_;
  run.tighten_from = knot_.stretch(Phase::tighten).from;
  const KnotJudge::Stretch sliding = knot_.stretch(Phase::slide);
  run.slide_from = sliding.from;
  run.release_from = knot_.stretch(Phase::release).from;
  run.free_from = knot_.stretch(Phase::free).from;
  if (!std::isnan(sliding.from)) {
    const Slide slide = knot_.slides().slide();
    run.slide_distance = slide.leading_way;
    run.slide_speed =
        sliding.to > sliding.from ? slide.leading_way / (sliding.to - sliding.from) : run.none;
    run.tail_distance = slide.trailing_way;
    run.taper_asks = slide.taper_asks;
    run.curvature_travel = slide.travel;
    run.curvature_correlation = slide.correlation;
    run.both_ends = slide_criteria(scene_, slide).at(1).value;
    run.slide = slide_name(slide);
    // The first frame of the slide has means of what was before it.
    if (rows_.size() > 1) run.sliding_force = median({rows_.begin() + 1, rows_.end()});
  }
  run.largest_thigmotaxis = largest_thigmotaxis_;
  run.largest_active = largest_active_;
  run.largest_torque = largest_torque_;
  run.pull = pull_.settled();
  run.penetration = worst_.penetration;
  run.skin_fold = knot_.skin_fold();
  run.limit_violation = worst_.limit_violation;
  run.head_drift = worst_.head_drift;
  run.kkt = worst_.kkt;
  run.eq6 = eq6_criterion(scene_.expect, met_, sliding_).value;
  run.energy_ledger = ledgers_.energy_off();
  run.energy_gain = ledgers_.energy_gain();
  run.energy_loss = ledgers_.energy_loss();
  run.momentum_ledger = ledgers_.momentum_off();
  run.work_tip = ledger_.work_tip;
  run.work_active = ledger_.work_active;
  run.work_thigmotaxis = ledger_.work[RowKind::thigmotaxis];
  run.dissipated = ledger_.dissipated;
  return run;
}

}  // namespace hagfish
