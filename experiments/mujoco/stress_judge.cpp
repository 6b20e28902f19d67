#include "experiments/mujoco/stress_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/knot/knot.hpp"
#include "core/log/means/thigmotaxis_rows.hpp"

namespace hagfish {
namespace {

/// Between steps the body is looked at whenever one of its points may have moved by this share of
/// the thinnest radius.
constexpr double stride = 0.25;
/// And no more often than this: 340 cm of way at the animal's thinnest, 0.68 cm.
constexpr int most_looks = 2000;

/// The configuration a share `u` of the way from q0 to q1.
Eigen::VectorXd between(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double u) {
  Eigen::VectorXd q = q0 + u * (q1 - q0);
  const Eigen::Quaterniond turned = root_orientation(q0).slerp(u, root_orientation(q1));
  q.segment<4>(3) << turned.w(), turned.x(), turned.y(), turned.z();
  return q;
}

/// "penetration 0.2 cm (at most 0.1)".
std::string unmet(const Criterion& criterion) {
  return fmt::format("{} {:.3g} {} (at {} {:g})", criterion.name, criterion.value, criterion.unit,
                     criterion.at_least ? "least" : "most", criterion.bound);
}

}  // namespace

StressJudge::StressJudge(const Model& model, const Scene& scene, const State& start, double energy)
    : model_(model), scene_(scene), gain_(energy), phase_(scene.start.phase), slides_(model) {
  const auto thinner = [](const Body& x, const Body& y) { return x.radius < y.radius; };
  thinnest_ = std::min_element(model.bodies.begin(), model.bodies.end(), thinner)->radius;
  const Observation observation = observe(model, start, scene);
  figures_.penetration = observation.penetration;
  figures_.path_penetration = std::max(0.0, -observation.contact.least_gap);
  figures_.limit_violation = observation.limit_violation;
  see_knot(observation, 0);
  knotted_at_start_ = figures_.knot == scene.expect.knot && !scene.expect.knot.empty();
}

void StressJudge::see(const State& before, const State& after, const Observation& observation,
                      double time, const EnergyState& energy) {
  figures_.time = time;
  figures_.penetration = std::max(figures_.penetration, observation.penetration);
  figures_.limit_violation = std::max(figures_.limit_violation, observation.limit_violation);
  gain_.see(energy.total, energy.put_in);
  figures_.energy_gain = gain_.largest();
  see_path(before, after, observation.kin);
  if (time + 0.5 * scene_.time.step >= knot_seen_ + scene_.knot.interval) {
    see_knot(observation, time);
  }
}

void StressJudge::see_path(const State& before, const State& after, const Kinematics& kin) {
  const double way = scene_.time.step * kin.centre_velocity.colwise().norm().maxCoeff();
  if (!std::isfinite(way)) {
    return;
  }
  const double looks = std::ceil(way / (stride * thinnest_));
  const int count = static_cast<int>(std::clamp(looks, 1.0, static_cast<double>(most_looks)));
  State on_the_way = after;
  Observation seen;
  for (int i = 1; i <= count; ++i) {
    on_the_way.q = between(before.q, after.q, static_cast<double>(i) / count);
    observe(model_, on_the_way, scene_, search_, seen);
    figures_.path_penetration = std::max(figures_.path_penetration, -seen.contact.least_gap);
  }
}

void StressJudge::see_knot(const Observation& observation, double time) {
  knot_seen_ = time;
  try {
    figures_.knot = knot_name(knot_type(observation.kin.centre, scene_.knot).type);
  } catch (const std::domain_error&) {
    figures_.knot = "touches itself";
  } catch (const std::overflow_error&) {
    figures_.knot = "tangle";
  }
  const bool holds = holds_knot(phase_) || (phase_ == Phase::form && knotted_at_start_);
  if (holds && !scene_.expect.knot.empty() && figures_.knot != scene_.expect.knot &&
      lost_.empty()) {
    lost_ = fmt::format("{} became {} at {:g} s", scene_.expect.knot, figures_.knot, time);
  }
}

void StressJudge::see_control(const StepRecord& record) {
  kkt_ = std::max(kkt_, record.solution.kkt.worst());
  phase_ = record.controller.phase;
  tied_ = tied_ || holds_knot(phase_);
  const std::optional<KnotSpan> span = knot_span(record.controller);
  if (phase_ != Phase::slide || !span) {
    return;
  }
  slides_.see(phase_, span, record.after.state.q);
  ++slide_steps_;
  slide_met_ += thigmotaxis_rows_of(record.control, record.solution, scene_.time.step).met ? 1 : 0;
}

Status StressJudge::root_cause() const {
  if (figures_.path_penetration > thinnest_) {
    return {Outcome::tunnelled,
            fmt::format("strands {:.3g} cm into each other, more than the radius {:.3g} cm",
                        figures_.path_penetration, thinnest_)};
  }
  if (!lost_.empty()) {
    return {Outcome::knot_lost, lost_};
  }
  if (const auto gain = energy_gain_criterion(scene_.expect, figures_.energy_gain); !gain.met()) {
    return {Outcome::energy_gain, unmet(gain)};
  }
  return {};
}

Status StressJudge::thigmotaxis() const {
  const ExpectSettings& expect = scene_.expect;
  if (expect.slide_distance > 0 && scene_.start.phase == Phase::form && !tied_) {
    return {Outcome::never_tied, "the knot was never ready to tighten"};
  }
  if (expect.slide_distance > 0 && slide_steps_ == 0) {
    return {Outcome::capped, "no slide"};
  }
  for (const Criterion& slide : slide_criteria(scene_, slides_.slide())) {
    if (expect.slide_distance > 0 && !slide.met()) return {Outcome::capped, unmet(slide)};
  }
  const auto eq6 = eq6_criterion(expect, slide_met_, slide_steps_);
  if (slide_steps_ > 0 && !eq6.met()) {
    return {Outcome::capped, unmet(eq6)};
  }
  if (expect.slide_distance > 0 && phase_ != Phase::free) {
    return {Outcome::capped, "the knot was not off in time"};
  }
  return {};
}

Status StressJudge::ended() const {
  const ExpectSettings& expect = scene_.expect;
  if (Status root = root_cause(); !root.ok()) {
    return root;
  }
  const double depth = std::max(figures_.penetration, figures_.path_penetration);
  for (const auto& [criterion, outcome] :
       {std::pair{penetration_criterion(scene_, depth), Outcome::penetration},
        {limits_criterion(expect, figures_.limit_violation), Outcome::limits},
        {kkt_criterion(expect, kkt_), Outcome::solver_failed}}) {
    if (!criterion.met()) {
      return {outcome, unmet(criterion)};
    }
  }
  return thigmotaxis();
}

Status StressJudge::stopped(const StepError& error) const {
  const bool symptom = error.outcome() == Outcome::penetration ||
                       error.outcome() == Outcome::limits || error.outcome() == Outcome::speed ||
                       error.outcome() == Outcome::knot_lost;
  if (const Status root = root_cause(); symptom && !root.ok()) {
    return {root.outcome, root.message + "; " + error.what()};
  }
  return {error.outcome(), error.what()};
}

}  // namespace hagfish
