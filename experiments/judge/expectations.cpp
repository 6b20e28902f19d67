#include "experiments/judge/expectations.hpp"

#include <fmt/format.h>

#include <numbers>

#include "core/run/momentum.hpp"

namespace hagfish {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double percent = 0.01;
/// The last frame of a slide is this near to its end: 20 ms at some cm/s, cm of arc.
constexpr double arrived_within = 0.2;
/// Share of expect.slide_distance that every animal must slide.
constexpr double least_slide = 0.5;

Criterion both_ends(const std::string& name, const ExpectSettings& expect, const Slide& slide) {
  return {name, slide.share() / percent, expect.slide_share / percent, "%", true};
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

Criterion penetration_criterion(const Scene& scene, double deepest) {
  return scene.flesh.present() ? Criterion{"overlap of flesh", deepest, scene.expect.overlap, "cm"}
                               : Criterion{"penetration", deepest, scene.expect.penetration, "cm"};
}

Criterion skin_fold_criterion(const ExpectSettings& expect, double largest) {
  return {"skin fold", largest, expect.skin_fold > 0 ? expect.skin_fold : INFINITY,
          "of radius of curvature"};
}

Criterion limits_criterion(const ExpectSettings& expect, double furthest) {
  return {"limits", furthest / degree, expect.limit_violation / degree, "deg"};
}

Criterion head_drift_criterion(const ExpectSettings& expect, double largest) {
  return {"head drift", largest, expect.head_drift, "cm"};
}

Criterion kkt_criterion(const ExpectSettings& expect, double largest) {
  return {"KKT residual", largest, expect.kkt, "scaled"};
}

Criterion energy_gain_criterion(const ExpectSettings& expect, double largest) {
  return {"energy gain", largest, expect.energy_gain, "of what there was and was put in"};
}

Criterion energy_loss_criterion(const ExpectSettings& expect, double largest) {
  return {"energy loss", largest, expect.energy_loss, "of the energy that passed"};
}

std::vector<Criterion> slide_criteria(const Scene& scene, const Slide& slide, bool whole) {
  const double asked = scene.expect.slide_distance;
  const double there = slide.from - scene.controller.release_at - arrived_within;
  const double least =
      std::isnan(there) ? asked : std::clamp(there, whole ? least_slide * asked : 0, asked);
  return {{"slide", slide.leading_way, least, "cm", true},
          both_ends("slide of both ends", scene.expect, slide)};
}

std::vector<Criterion> way_back_criteria(const Scene& scene, const Slide& way_back) {
  return {{"reverse", way_back.leading_way, scene.expect.reverse_distance, "cm", true},
          both_ends("reverse of both ends", scene.expect, way_back)};
}

Criterion torque_criterion(const Scene& scene, double largest) {
  return {"torque", largest / scene.active.capacity, scene.expect.torque_share,
          "of active.capacity"};
}

Criterion pull_criterion(const ExpectSettings& expect, double mean) {
  return {"pull", mean / dyn_per_newton, expect.pull, "N", true};
}

Criterion pull_drift_criterion(const ExpectSettings& expect, double earlier, double later) {
  const double drift = std::abs(later - earlier) / std::abs(0.5 * (earlier + later));
  return {"pull steady", drift, expect.pull_drift, "of its mean"};
}

Criterion pull_balance_criterion(const ExpectSettings& expect, double plate, double pull) {
  return {"pull balance", std::abs(plate - pull) / std::abs(pull), expect.pull_balance,
          "of the pull"};
}

Criterion eq6_criterion(const ExpectSettings& expect, std::int64_t met, std::int64_t steps) {
  const double share = steps > 0 ? static_cast<double>(met) / static_cast<double>(steps) : NAN;
  return {"Eq. 6", share / percent, expect.speed_share / percent, "% of sliding steps", true};
}

Passed::Passed(const Model& model, double h)
    : mass_(model.mass()),
      weight_(mass_ * model.gravity.norm()),
      arm_(model.length() / std::sqrt(12.0)),
      h_(h) {}

void Passed::see(double elapsed, const Eigen::Vector3d& tip, const Eigen::VectorXd& head,
                 const Eigen::VectorXd& obstacles) {
  const double force = weight_ + tip.norm() + head.head<3>().norm() + obstacles.head<3>().norm();
  momentum_ += elapsed * force;
  step_momentum_ = std::max(step_momentum_, h_ * force);
}

void EnergyGain::see(double energy, double put_in, double gravity) {
  const double had = start_ + put_in;
  most_ = std::max(most_, had - gravity);
  largest_ = worse(largest_, most_ > 0 ? (energy - had) / most_ : 0);
}

}  // namespace hagfish
