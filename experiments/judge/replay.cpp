#include "experiments/judge/replay.hpp"

#include <cmath>

#include "core/log/ledger_columns.hpp"
#include "core/log/reading/logged_run.hpp"

namespace hagfish {
namespace {

/// Of each frame, dyn; of logs before 0.3 those of the knot's ends, which is all that they hold.
std::vector<double> sums_of_rows(const LogContents& log) {
  const std::string path = "/mean/thigmotaxis/sum";
  if (log.h5.has(path)) return log.h5.doubles(path);
  const Eigen::VectorXd sums = log.h5.rows("/mean/thigmotaxis/lambda").rowwise().sum();
  return {sums.begin(), sums.end()};
}

}  // namespace

LogFrames::LogFrames(const LogContents& log)
    : log_(log),
      head_end_(log.h5.doubles("/knot/head_end")),
      tail_end_(log.h5.doubles("/knot/tail_end")),
      tip_(log.h5.rows("/forces/tip")),
      active_(log.h5.rows("/mean/forces/active")),
      thigmotaxis_(log.h5.rows("/mean/forces/thigmotaxis")),
      head_(log.h5.rows("/mean/forces/head")),
      obstacles_(log.h5.rows("/mean/forces/wall")),
      rows_(sums_of_rows(log)),
      energy_(log.time.size()),
      momentum_(log.time.size()) {
  visit_energies([this](const std::string& name, const std::string& /*what*/, const auto& of) {
    const std::string path = "/diagnostics/" + name;
    const std::vector<double> values =
        log_.h5.has(path) ? log_.h5.doubles(path) : std::vector<double>(energy_.size(), NAN);
    for (std::size_t f = 0; f < energy_.size(); ++f) of(energy_[f]) = values[f];
  });
  for (const MomentumColumn& column : momentum_columns) {
    const auto fill = [&](const char* name, Eigen::Vector3d Momentum::*part) {
      const std::string path = std::string("/diagnostics/") + name;
      const Hdf5Reader::Rows rows =
          log_.h5.has(path)
              ? log_.h5.rows(path)
              : Hdf5Reader::Rows::Constant(static_cast<Eigen::Index>(momentum_.size()), 3, NAN);
      for (std::size_t f = 0; f < momentum_.size(); ++f) {
        momentum_[f].*column.member.*part = rows.row(static_cast<Eigen::Index>(f));
      }
    };
    fill(column.linear, &Momentum::linear);
    fill(column.angular, &Momentum::angular);
  }
}

RunFrame LogFrames::at(Eigen::Index frame) const {
  const auto f = static_cast<std::size_t>(frame);
  const bool knotted = !std::isnan(head_end_[f]) && !std::isnan(tail_end_[f]);
  return {.time = log_.time[f],
          .phase = static_cast<Phase>(log_.phase[f]),
          .clamped = log_.clamped(frame),
          .at_end = frame >= log_.begun,
          .span = knotted ? std::optional(KnotSpan{head_end_[f], tail_end_[f]}) : std::nullopt,
          .q = log_.q.row(frame),
          .tip = tip_.row(frame),
          .active = active_.row(frame),
          .thigmotaxis = thigmotaxis_.row(frame),
          .head = head_.row(frame),
          .obstacles = obstacles_.row(frame),
          .rows = rows_[f],
          .energy = energy_[f],
          .momentum = momentum_[f]};
}

std::vector<KnotInvariants> logged_knots(const LogContents& log) {
  const std::vector<std::int64_t> determinant = log.h5.integers("/knot/determinant"),
                                  v2 = log.h5.integers("/knot/v2");
  std::vector<KnotInvariants> types;
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    types.push_back({static_cast<int>(determinant[f]), static_cast<int>(v2[f])});
  }
  return types;
}

void replay(const LogContents& log, Judge& judge) {
  const LogFrames frames(log);
  const bool full = level_of(log.h5) == LogLevel::full;
  const std::string group = full ? "/steps/" : "/diagnostics/";
  const auto read = [&](const char* name) { return log.h5.doubles(group + name); };
  const std::vector<double> penetration = read("penetration"),
                            limit_violation = read("limit_violation"),
                            head_drift = read("head_drift"), kkt = read(full ? "kkt" : "kkt_worst");
  const auto worst = [&](std::size_t k) {
    return Worst{penetration[k], limit_violation[k], head_drift[k], kkt[k]};
  };
  if (!full) {
    for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
      judge.see(frames.at(f));
      judge.see(worst(static_cast<std::size_t>(f)));
    }
    return;
  }
  const std::vector<std::int64_t> step = log.h5.integers("/trajectory/step"),
                                  eq6 = log.h5.integers("/steps/eq6");
  std::size_t k = 0;
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    judge.see(frames.at(f));
    const auto next = static_cast<std::size_t>(f) + 1;
    const auto end = next < step.size() ? static_cast<std::size_t>(step[next] - step.front())
                                        : penetration.size();
    for (; k < end && k < penetration.size(); ++k) {
      judge.see(RunStep{worst(k), static_cast<int>(eq6.at(k))});
    }
  }
}

Judge judged_log(const LogContents& log) {
  Judge judge(log.model, log.resolved.scene, log.h5.has_root_attribute("branched_from"));
  replay(log, judge);
  return judge;
}

}  // namespace hagfish
