#include "experiments/judge/pull_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/control/controller.hpp"

namespace hagfish {
namespace {

constexpr std::size_t frames_for_halves = 4;  // for two halves of a pull

/// Whether the run comes to a pull at all.
bool pulls_at_food(const Scene& scene) {
  return scene.food.hold != 0 && phase_order(scene.time.until) >= phase_order(Phase::pull);
}

/// Whether it is a pull that settles: one that rises does not.
bool settles(const Scene& scene) { return scene.food.cap.to == scene.food.cap.from; }

/// Mean of a member over the places from `from` to before `to`.
template <class Means>
double mean(const std::vector<Means>& means, double Means::*what, std::size_t from,
            std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += means[k].*what;
  return sum / static_cast<double>(to - from);
}

}  // namespace

void PullJudge::see(const RunFrame& frame) {
  // The means before the state at the end may be of less time.
  if (!pulls_at_food(scene_) || frame.at_end) return;
  const double drag = frame.momentum.drag.linear.x();
  const double elapsed = frames_.empty() ? NAN : frame.time - frames_.back().time;
  frames_.push_back({frame.time, frame.phase == Phase::pull, pull_of(frame.head),
                     frame.obstacles[0], (drag - drag_before_) / elapsed});
  drag_before_ = drag;
}

std::vector<std::size_t> PullJudge::intervals() const {
  std::vector<std::size_t> found;
  for (std::size_t f = 1; f < frames_.size(); ++f) {
    if (frames_[f - 1].pulls && frames_[f].pulls) found.push_back(f);
  }
  return found;
}

std::vector<PullJudge::Means> PullJudge::settled_part() const {
  const std::vector<std::size_t> pull = intervals();
  std::vector<Means> part;
  for (const std::size_t f : pull) {
    const double since = frames_[f].time - frames_[pull.front()].time;
    if (since >= scene_.expect.pull_settled) part.push_back(frames_[f]);
  }
  return part;
}

std::vector<Criterion> PullJudge::criteria(const ExpectSettings& expect,
                                           const std::vector<Means>& settled) {
  const std::size_t count = settled.size();
  if (count < frames_for_halves) return {};
  const auto force = [&](std::size_t from, std::size_t to) {
    return mean(settled, &Means::force, from, to);
  };
  const double all = force(0, count);
  return {pull_criterion(expect, all),
          pull_drift_criterion(expect, force(0, count / 2), force(count / 2, count)),
          pull_balance_criterion(expect, mean(settled, &Means::plate, 0, count), all)};
}

double PullJudge::settled() const {
  const std::vector<Criterion> judged = criteria(scene_.expect, settled_part());
  return judged.empty() ? NAN : judged.front().value;
}

std::vector<Finding> PullJudge::of_settled() const {
  const std::vector<Means> part = settled_part();
  const std::size_t count = part.size();
  const std::vector<Criterion> found = criteria(scene_.expect, part);
  if (found.empty()) {
    return {{"pull", false, fmt::format("{} frames of a settled pull, too few to judge", count), "",
             "", "N"}};
  }
  const double of_water = mean(part, &Means::water, 0, count) / mean(part, &Means::force, 0, count);
  return {judged_over(found[0], fmt::format("{} frames", count)),
          judged_over(found[1], "later half against earlier"),
          judged_over(found[2], fmt::format("head plate against head; the water pushes {:.2g} of "
                                            "it along x",
                                            of_water))};
}

/// The pull ends where the food gives or the animal lets go, and not before. What it gives at is
/// known where means of frames are those by which it does.
Finding PullJudge::end(const std::vector<std::size_t>& pull) const {
  const FoodSettings& food = scene_.food;
  const TimeSettings& time = scene_.time;
  const auto of_mean = [&](std::size_t f) { return frames_[f].force / dyn_per_newton; };
  double most = -INFINITY;
  for (const std::size_t f : pull) most = std::max(most, of_mean(f));
  const std::size_t last = pull.back();
  const double lasted = frames_[last].time - frames_[pull.front()].time;
  const bool known = std::abs(food.average - time.frame_interval) < 0.5 * time.step;
  const bool over = last + 1 < frames_.size();
  // The pull may begin two frames before its first whole interval's end, and end one after the
  // last.
  const bool let_go = over && lasted + 3 * time.frame_interval >= food.hold;
  const bool gave = over && !let_go;
  const double at = gave ? of_mean(last + 1) : most;
  const bool right = !known || (most <= food.strength && (!gave || at > food.strength));
  const std::string text =
      fmt::format("{} after {:.2f} s; largest mean of {:g} s before {:.4g} N, strength {:g} N{}",
                  gave   ? fmt::format("gave at {:.4g} N", at)
                  : over ? "let go"
                         : "still held",
                  lasted, time.frame_interval, most, food.strength,
                  known ? "" : "; means of food.average are not in the log");
  return {"food", right, text, fmt::format("{}", at), fmt::format("{}", food.strength), "N"};
}

std::vector<Finding> PullJudge::findings() const {
  if (!pulls_at_food(scene_)) return {};
  const std::vector<std::size_t> pull = intervals();
  if (pull.empty()) return {{"pull", false, "the knot never pulled", "", "", "N"}};
  std::vector<Finding> findings;
  if (settles(scene_)) findings = of_settled();
  findings.push_back(end(pull));
  return findings;
}

}  // namespace hagfish
