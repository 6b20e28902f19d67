#include "experiments/audit/audit_pull.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/run/controller.hpp"
#include "experiments/audit/expectations.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {
namespace {

constexpr std::size_t frames_for_halves = 4;  // for two halves of a pull

bool pulls(const LogContents& log, Eigen::Index frame) {
  return static_cast<Phase>(log.phase[frame]) == Phase::pull;
}

/// Those of the first `count` frames, of the pull, whose frame before is of it too: all steps
/// between them are.
std::vector<Eigen::Index> intervals(const LogContents& log, Eigen::Index count) {
  std::vector<Eigen::Index> frames;
  for (Eigen::Index f = 1; f < count; ++f) {
    if (pulls(log, f - 1) && pulls(log, f)) {
      frames.push_back(f);
    }
  }
  return frames;
}

/// /pull from the means of what it is made of.
Finding figures(const LogContents& log) {
  const Hdf5Reader::Rows head = log.h5.rows("/mean/forces/head");
  const Hdf5Reader::Rows wall = log.h5.rows("/mean/forces/wall");
  const Hdf5Reader::Rows torque =
      log.h5.rows("/mean/forces/active") + log.h5.rows("/mean/forces/thigmotaxis");
  const Eigen::VectorXd rows = log.h5.rows("/mean/thigmotaxis/lambda").rowwise().sum();
  const Hdf5Reader::Rows bearing = log.h5.rows("/pull/bearing");
  std::vector<bool> of_pull(log.time.size(), false);
  for (const Eigen::Index f : intervals(log, log.q.rows())) {
    of_pull[f] = true;
  }
  Rebuilt rebuilt;
  const auto compare = [&](const char* name, const auto& wanted) {
    const std::string path = std::string("/pull/") + name;
    const std::vector<double> logged = log.h5.doubles(path);
    for (std::size_t f = 0; f < logged.size(); ++f) {
      rebuilt.compare(path, logged[f], of_pull[f] ? wanted(static_cast<Eigen::Index>(f)) : NAN);
    }
  };
  const auto over = [](double a, double b) { return b > 0 ? a / b : NAN; };
  const auto most = [&](Eigen::Index f) {
    return torque.row(f).tail(torque.cols() - root_dofs).cwiseAbs().maxCoeff();
  };
  compare("force", [&](Eigen::Index f) { return -head(f, 0); });
  compare("plate", [&](Eigen::Index f) { return wall(f, 0); });
  compare("torque", most);
  compare("advantage_rows", [&](Eigen::Index f) { return over(-head(f, 0), rows[f]); });
  compare("advantage_torque", [&](Eigen::Index f) { return over(-head(f, 0), most(f)); });
  for (Eigen::Index f = 0; f < bearing.rows(); ++f) {
    const bool on = of_pull[f] && wall(f, 0) > 0;
    rebuilt.compare("/pull/bearing", bearing(f, 0), on ? -wall(f, 5) / wall(f, 0) : NAN);
    rebuilt.compare("/pull/bearing", bearing(f, 1), on ? wall(f, 4) / wall(f, 0) : NAN);
  }
  return rebuilt.finding("figures of the pull",
                         "means of clamp, head plate, rows of Eq. 6 and torques");
}

double mean(const std::vector<PullMeans>& means, double PullMeans::*what, std::size_t from,
            std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += means[k].*what;
  return sum / static_cast<double>(to - from);
}

/// What the pull is once it has settled.
std::vector<Finding> settled(const LogContents& log, const std::vector<Eigen::Index>& frames) {
  const ExpectSettings& expect = log.resolved.scene.expect;
  const Hdf5Reader::Rows head = log.h5.rows("/mean/forces/head");
  const Hdf5Reader::Rows wall = log.h5.rows("/mean/forces/wall");
  const Hdf5Reader::Rows drag = log.h5.rows("/diagnostics/impulse_drag");
  std::vector<PullMeans> all;
  for (const Eigen::Index f : frames) {
    all.push_back({log.time[f], -head(f, 0), wall(f, 0),
                   (drag(f, 0) - drag(f - 1, 0)) / (log.time[f] - log.time[f - 1])});
  }
  const std::vector<PullMeans> part = settled_part(expect, all);
  const std::size_t count = part.size();
  const std::vector<Criterion> criteria = pull_criteria(expect, part);
  if (criteria.empty()) {
    return {{"pull", false, fmt::format("{} frames of a settled pull, too few to judge", count), "",
             "", "N"}};
  }
  const double of_water =
      mean(part, &PullMeans::water, 0, count) / mean(part, &PullMeans::force, 0, count);
  return {
      judged_over(criteria[0], fmt::format("{} frames", count)),
      judged_over(criteria[1], "later half against earlier"),
      judged_over(criteria[2], fmt::format("head plate against head; the water pushes {:.2g} of "
                                           "it along x",
                                           of_water))};
}

/// The pull ends where the food gives or the animal lets go, and not before. What it gives at is
/// known where means of the log are those by which it does.
Finding end(const LogContents& log, const std::vector<Eigen::Index>& frames) {
  const FoodSettings& food = log.resolved.scene.food;
  const TimeSettings& time = log.resolved.scene.time;
  const Hdf5Reader::Rows head = log.h5.rows("/mean/forces/head");
  const auto of_mean = [&](Eigen::Index f) { return -head(f, 0) / dyn_per_newton; };
  double most = -INFINITY;
  for (const Eigen::Index f : frames) {
    most = std::max(most, of_mean(f));
  }
  const Eigen::Index last = frames.back();
  const double lasted = log.time[last] - log.time[frames.front()];
  const bool known = std::abs(food.average - time.frame_interval) < 0.5 * time.step;
  const bool over = last + 1 < log.begun;
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

}  // namespace

bool pulls_at_food(const Scene& scene) {
  return scene.food.hold != 0 && phase_order(scene.time.until) >= phase_order(Phase::pull);
}

bool settles(const Scene& scene) { return scene.food.cap.to == scene.food.cap.from; }

std::vector<PullMeans> settled_part(const ExpectSettings& expect,
                                    const std::vector<PullMeans>& pull) {
  std::vector<PullMeans> part;
  for (const PullMeans& means : pull) {
    if (means.time >= pull.front().time + expect.pull_settled) part.push_back(means);
  }
  return part;
}

std::vector<Criterion> pull_criteria(const ExpectSettings& expect,
                                     const std::vector<PullMeans>& settled) {
  const std::size_t count = settled.size();
  if (count < frames_for_halves) {
    return {};
  }
  const auto force = [&](std::size_t from, std::size_t to) {
    return mean(settled, &PullMeans::force, from, to);
  };
  const double all = force(0, count);
  return {pull_criterion(expect, all),
          pull_drift_criterion(expect, force(0, count / 2), force(count / 2, count)),
          pull_balance_criterion(expect, mean(settled, &PullMeans::plate, 0, count), all)};
}

std::vector<Finding> audit_pull(const LogContents& log) {
  std::vector<Finding> findings{figures(log)};
  const Scene& scene = log.resolved.scene;
  if (!pulls_at_food(scene)) {
    return findings;
  }
  // The means before the state at the end are of less time.
  const std::vector<Eigen::Index> frames = intervals(log, log.begun);
  if (frames.empty()) {
    findings.push_back({"pull", false, "the knot never pulled", "", "", "N"});
    return findings;
  }
  if (settles(scene)) {
    const std::vector<Finding> more = settled(log, frames);
    findings.insert(findings.end(), more.begin(), more.end());
  }
  findings.push_back(end(log, frames));
  return findings;
}

}  // namespace hagfish
