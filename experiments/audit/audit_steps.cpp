#include "experiments/audit/audit_steps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/log/thigmotaxis_rows.hpp"
#include "core/run/laws.hpp"
#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/log_schema.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {
namespace {

/// A slack of nothing but rounding has no scale of its own, cm/s.
constexpr double slack_tolerance = 1e-9;

/// Datasets along frames that are of the step that begins there, by how their paths begin.
constexpr const char* of_a_step[] = {"/trajectory/qdot_next",
                                     "/trajectory/q_ref",
                                     "/forces/",
                                     "/midway/",
                                     "/thigmotaxis/command",
                                     "/thigmotaxis/speed",
                                     "/thigmotaxis/slack",
                                     "/thigmotaxis/cap",
                                     "/control/t",
                                     "/basis/",
                                     "/reflex/",
                                     "/muscle/driven",
                                     "/diagnostics/kkt_stationarity",
                                     "/diagnostics/kkt_primal",
                                     "/diagnostics/kkt_complementarity",
                                     "/diagnostics/qp_time"};

/// What each step says of rows at other contacts than the knot's ends; nothing of the paper's law.
struct OtherRows {
  explicit OtherRows(const LogContents& log) {
    if (!law_of(log.resolved.scene).logs_rows) return;
    count = log.h5.integers("/steps/thigmotaxis_others");
    slack = log.h5.doubles("/steps/thigmotaxis_others_slack");
  }
  /// How many a step has, and their largest slack.
  std::int64_t at(Eigen::Index step) const { return count.empty() ? 0 : count[step]; }
  std::vector<std::int64_t> count;
  std::vector<double> slack;
};

/// These at frames, from /eq6.
void rebuild_others(const LogContents& log, const Steps& steps, Rebuilt& rebuilt) {
  const OtherRows others(log);
  if (others.count.empty()) return;
  std::vector<std::int64_t> count(log.time.size(), 0);
  std::vector<double> most(log.time.size(), NAN);
  const std::vector<std::int64_t> frame = log.h5.integers("/eq6/frame");
  const std::vector<std::int64_t> end = log.h5.integers("/eq6/end");
  const std::vector<double> slack = log.h5.doubles("/eq6/slack");
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (end[i] == static_cast<std::int64_t>(KnotEnd::neither)) {
      ++count[frame[i]];
      most[frame[i]] = std::fmax(most[frame[i]], slack[i]);
    }
  }
  for (Eigen::Index f = 0; f < log.begun; ++f) {
    const Eigen::Index s = steps.at(f);
    rebuilt.compare_exactly("/steps/thigmotaxis_others", others.count[s], count[f]);
    rebuilt.compare("/steps/thigmotaxis_others_slack", others.slack[s], most[f], slack_tolerance);
  }
}

/// /steps/eq6 from each step's slack, against the command of the frame before or after it: a phase
/// may end in between.
void rebuild_eq6(const LogContents& log, const Steps& steps, Rebuilt& rebuilt) {
  const std::vector<std::int64_t> eq6 = log.h5.integers("/steps/eq6");
  const OtherRows others(log);
  const Hdf5Reader::Rows slack = log.h5.rows("/steps/thigmotaxis_slack");
  const Hdf5Reader::Rows command = log.h5.rows("/thigmotaxis/command");
  const auto verdict = [&](Eigen::Index s, Eigen::Index frame) -> std::int64_t {
    int met = slack.row(s).array().isNaN().all() && others.at(s) == 0 ? -1 : 1;
    for (int k = 0; k < 4 && met == 1; ++k) {
      // Without rows at that frame the tolerance is that of 1 cm/s.
      const double asked = std::isnan(command(frame, k)) ? 0 : command(frame, k);
      met = std::isnan(slack(s, k)) || meets_command(slack(s, k), asked) ? 1 : 0;
    }
    return met == 1 && others.at(s) > 0 && !meets_command(others.slack[s], 0) ? 0 : met;
  };
  for (Eigen::Index s = 0; s < slack.rows(); ++s) {
    const Eigen::Index before = s / steps.stride;
    const Eigen::Index after = std::min(before + 1, log.begun - 1);
    const bool same = eq6[s] == verdict(s, before) || eq6[s] == verdict(s, after);
    rebuilt.compare_exactly("/steps/eq6", same ? 1 : 0, 1);
  }
}

/// Eq. 6 at frames, and its means, from what each step says.
void rebuild_thigmotaxis(const LogContents& log, const Steps& steps, Rebuilt& rebuilt) {
  const Hdf5Reader::Rows lambda = log.h5.rows("/steps/thigmotaxis_lambda");
  const Hdf5Reader::Rows speed = log.h5.rows("/steps/thigmotaxis_speed");
  const Hdf5Reader::Rows slack = log.h5.rows("/steps/thigmotaxis_slack");
  const std::tuple<const char*, const Hdf5Reader::Rows*, double> series[] = {
      {"/thigmotaxis/lambda", &lambda, 0},
      {"/thigmotaxis/speed", &speed, 0},
      {"/thigmotaxis/slack", &slack, slack_tolerance}};
  for (const auto& [path, steps_of, allowed] : series) {
    const Hdf5Reader::Rows& each = *steps_of;
    const Hdf5Reader::Rows at_frame = log.h5.rows(path);
    const std::string mean_path = std::string("/mean") + path;
    const Hdf5Reader::Rows mean = log.h5.rows(mean_path);
    for (Eigen::Index f = 0; f < mean.rows(); ++f) {
      const Eigen::Index begin = f > 0 ? steps.at(f - 1) : 0;
      for (int k = 0; k < 4; ++k) {
        if (f < log.begun) {
          rebuilt.compare(path, at_frame(f, k), each(steps.at(f), k), allowed);
        }
        double sum = 0;
        double count = 0;
        for (Eigen::Index s = begin; s < steps.at(f); ++s) {
          if (!std::isnan(each(s, k))) {  // no row; of forces, 0
            sum += each(s, k);
            count += 1;
          }
        }
        rebuilt.compare(mean_path, mean(f, k), sum / count, allowed);
      }
    }
  }
  const Hdf5Reader::Rows command = log.h5.rows("/thigmotaxis/command");
  for (Eigen::Index f = 0; f < log.begun; ++f) {
    for (int k = 0; k < 4; ++k) {
      const double wanted = std::max(0.0, command(f, k) - speed(steps.at(f), k));
      rebuilt.compare("/thigmotaxis/slack against command and speed", slack(steps.at(f), k),
                      std::isnan(command(f, k)) ? NAN : wanted, slack_tolerance);
    }
  }
}

/// Worst figures since the frame before, from those of each step; of the state at the end, which
/// counts too, FrameAudit asks.
void rebuild_worst(const LogContents& log, const Steps& steps, Rebuilt& rebuilt) {
  const std::pair<const char*, const char*> worst[] = {
      {"/diagnostics/kkt_worst", "/steps/kkt"},
      {"/diagnostics/penetration", "/steps/penetration"},
      {"/diagnostics/limit_violation", "/steps/limit_violation"},
      {"/diagnostics/head_drift", "/steps/head_drift"}};
  for (const auto& [path, of_steps] : worst) {
    const std::vector<double> logged = log.h5.doubles(path);
    const std::vector<double> each = log.h5.doubles(of_steps);
    for (Eigen::Index f = 0; f < log.begun; ++f) {
      const auto begin = each.begin() + (f > 0 ? steps.at(f - 1) + 1 : 0);
      rebuilt.compare(path, logged[f], *std::max_element(begin, each.begin() + steps.at(f) + 1));
    }
  }
}

/// What the solver says of the step at a frame, against what it says of all steps.
void rebuild_solver(const LogContents& log, const Steps& steps, Rebuilt& rebuilt) {
  for (const char* name : {"solve", "rows", "iterations"}) {
    const std::string path = std::string("/diagnostics/") + name;
    const std::vector<std::int64_t> logged = log.h5.integers(path);
    const std::vector<std::int64_t> each = log.h5.integers(std::string("/steps/") + name);
    for (Eigen::Index f = 0; f < log.begun; ++f) {
      rebuilt.compare_exactly(path, logged[f], each[steps.at(f)]);
    }
  }
  const std::vector<double> time = log.h5.doubles("/diagnostics/qp_time");
  const std::vector<double> each_time = log.h5.doubles("/steps/qp_time");
  const std::vector<double> kkt = log.h5.doubles("/steps/kkt");
  std::vector<std::vector<double>> residuals;
  for (const char* name : {"kkt_stationarity", "kkt_primal", "kkt_complementarity"}) {
    residuals.push_back(log.h5.doubles(std::string("/diagnostics/") + name));
  }
  for (Eigen::Index f = 0; f < log.begun; ++f) {
    const Eigen::Index s = steps.at(f);
    rebuilt.compare("/diagnostics/qp_time", time[f], each_time[s]);
    rebuilt.compare("/steps/kkt at frames", kkt[s],
                    std::max({residuals[0][f], residuals[1][f], residuals[2][f]}));
  }
}

/// What the last frame says of a step where it is the state at the end: nothing.
void rebuild_end(const LogContents& log, Rebuilt& rebuilt) {
  if (!log.has_end()) return;
  for (const DatasetForm& form : log_forms(log.h5, log.model, log.resolved.scene)) {
    const std::string& path = form.path;
    if (std::ranges::none_of(of_a_step, [&](const char* b) { return path.starts_with(b); })) {
      continue;
    }
    const Hdf5Reader::Rows rows = log.h5.rows(path);
    rebuilt.compare(path, rows.row(log.begun).transpose(),
                    Eigen::VectorXd::Constant(rows.cols(), NAN));
  }
  for (const char* path : {"/diagnostics/solve", "/diagnostics/rows", "/diagnostics/active",
                           "/diagnostics/iterations"}) {
    rebuilt.compare_exactly(path, log.h5.integers(path).back(), 0);
  }
  for (const char* path : {"/thigmotaxis/body_a", "/thigmotaxis/body_b"}) {
    rebuilt.compare_exactly(path, log.h5.integers(path).back(), -1);
  }
  rebuilt.compare("/thigmotaxis/lambda", log.h5.rows("/thigmotaxis/lambda").row(log.begun),
                  Eigen::Vector4d::Zero());
}

/// /steps/time from the step and its index, as the run makes it.
void rebuild_time(const LogContents& log, const Steps& steps, Rebuilt& rebuilt) {
  const std::vector<double> time = log.h5.doubles("/steps/time");
  for (std::size_t s = 0; s < time.size(); ++s) {
    const double wanted = static_cast<double>(steps.first + static_cast<std::int64_t>(s)) *
                          log.resolved.scene.time.step;
    rebuilt.compare("/steps/time", time[s], wanted);
  }
}

/// Figures that cannot be below zero, or that must not fall.
Finding plausible(const LogContents& log) {
  std::vector<std::string> failed;
  const auto ask = [&failed](const std::string& path, bool met) {
    if (!met) failed.push_back(path);
  };
  for (const char* path :
       {"/steps/kkt", "/steps/penetration", "/steps/limit_violation", "/steps/head_drift",
        "/steps/qp_time", "/diagnostics/kkt_stationarity", "/diagnostics/kkt_primal",
        "/diagnostics/kkt_complementarity", "/diagnostics/wall_time"}) {
    std::vector<double> values = log.h5.doubles(path);
    const bool of_frame =
        std::ranges::find(of_a_step, std::string_view(path)) != std::end(of_a_step);
    if (of_frame) values.resize(log.begun);
    ask(path, std::all_of(values.begin(), values.end(),
                          [](double v) { return v >= 0 && std::isfinite(v); }));
  }
  const std::vector<double> left_out = log.h5.doubles("/steps/left_out");
  const double step = log.resolved.scene.time.step;
  ask("/steps/left_out", std::all_of(left_out.begin(), left_out.end(),
                                     [step](double v) { return v >= 0 && v <= step; }));
  const std::vector<double> wall = log.h5.doubles("/diagnostics/wall_time");
  ask("/diagnostics/wall_time falls", std::is_sorted(wall.begin(), wall.end()));
  const std::vector<std::int64_t> solve = log.h5.integers("/steps/solve");
  const std::vector<std::int64_t> rows = log.h5.integers("/steps/rows");
  const std::vector<std::int64_t> iterations = log.h5.integers("/steps/iterations");
  constexpr auto linear = static_cast<std::int64_t>(SolveKind::linear);
  constexpr auto qp = static_cast<std::int64_t>(SolveKind::qp);
  bool kinds = true;
  bool counts = true;
  for (std::size_t s = 0; s < solve.size(); ++s) {
    kinds = kinds && (solve[s] == linear) == (rows[s] == 0);
    counts = counts && iterations[s] >= 0 && (solve[s] == qp || iterations[s] == 0);
  }
  ask("/steps/solve against /steps/rows", kinds);
  ask("/steps/iterations against /steps/solve", counts);
  return judged({"plausible", static_cast<double>(failed.size()), 0, "datasets"},
                failed.empty() ? "nothing below zero or against its kind at any step"
                               : fmt::format("below zero, not finite or against its kind: {}",
                                             fmt::join(failed, ", ")));
}

}  // namespace

std::vector<Finding> audit_steps(const LogContents& log) {
  const Steps steps(log);
  Rebuilt rebuilt;
  rebuild_eq6(log, steps, rebuilt);
  rebuild_others(log, steps, rebuilt);
  rebuild_thigmotaxis(log, steps, rebuilt);
  rebuild_worst(log, steps, rebuilt);
  rebuild_solver(log, steps, rebuilt);
  rebuild_time(log, steps, rebuilt);
  rebuild_end(log, rebuilt);
  return {rebuilt.finding("steps and frames", "every step"), plausible(log)};
}

}  // namespace hagfish
