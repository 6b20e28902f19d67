#include "experiments/benchmarks/qp_measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "solvers/ipopt_box_qp.hpp"

namespace hagfish {
namespace {

constexpr const char* ipopt = "ipopt";
/// Ipopt's own point, without crossover to a vertex.
constexpr const char* unpolished = "ipopt-unpolished";
constexpr std::size_t failures_told = 10;

std::unique_ptr<BoxQpSolver> make(const BackEnd& back_end) {
  if (back_end.name != ipopt && back_end.name != unpolished) {
    return make_box_qp_solver(back_end.name);
  }
  IpoptSettings settings;
  settings.polish = back_end.name == ipopt;
  if (std::isnan(back_end.tolerance)) {
    return std::make_unique<IpoptBoxQp>(settings);
  }
  if (settings.polish) {
    settings.polished_tolerance = back_end.tolerance;
  } else {
    settings.tolerance = back_end.tolerance;
    settings.accepted = std::max(settings.accepted, 10 * back_end.tolerance);
  }
  return std::make_unique<IpoptBoxQp>(settings);
}

/// Whether answers to one QP can start the next.
bool carries_over(const StoredQp& before, const StoredQp& now) {
  const auto bilateral = [](const StoredQp& qp) { return qp.primal ? qp.primal->e.size() : 0; };
  return before.sequence && before.sequence == now.sequence &&
         before.box.b.size() == now.box.b.size() && bilateral(before) == bilateral(now);
}

/// A back end with one kind of start.
struct Contestant {
  std::unique_ptr<BoxQpSolver> solver;
  BoxQpSolution answer;  ///< to the QP now, and until then to the one before
  double time = 0;

  void solve(const BoxQp& qp, const Eigen::VectorXd& start) {
    const auto begin = std::chrono::steady_clock::now();
    BoxQpSolution solution = solver->solve(qp, start);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    time = std::min(time, taken.count());
    answer = std::move(solution);
  }
};

class Contest {
 public:
  Contest(const std::vector<BackEnd>& back_ends, int repeat) : repeat_(repeat) {
    for (const BackEnd& back_end : back_ends) {
      for (const bool warm : {false, true}) {
        contestants_.emplace_back().solver = make(back_end);
        report_.rows.push_back({back_end, warm, {}, 0, {}, 0, 0});
      }
    }
  }

  void take(const StoredQp& qp, const StoredQp* before) {
    const bool carried = qp.start.size() == 0 && before != nullptr && carries_over(*before, qp);
    report_.stored_starts += qp.start.size() > 0 ? 1 : 0;
    report_.carried_starts += carried ? 1 : 0;
    report_.sequences +=
        before == nullptr || !qp.sequence || before->sequence != qp.sequence ? 1 : 0;
    report_.primal += qp.primal ? 1 : 0;
    report_.row_counts.push_back(qp.box.b.size());
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(qp.box.b.size());
    std::vector<Eigen::VectorXd> start(contestants_.size(), zero);
    for (std::size_t k = 0; k < contestants_.size(); ++k) {
      if (report_.rows[k].warm && (carried || qp.start.size() > 0)) {
        start[k] = carried ? contestants_[k].answer.x : qp.start;
      }
      contestants_[k].time = std::numeric_limits<double>::infinity();
    }
    for (int turn = 0; turn < repeat_; ++turn) {
      for (std::size_t k = 0; k < contestants_.size(); ++k) {
        contestants_[k].solve(qp.box, start[k]);
      }
    }
    judge(qp);
  }

  const QpReport& report() const { return report_; }

 private:
  void judge(const StoredQp& qp) {
    std::vector<std::size_t> solved;  // contestants, best first
    std::vector<double> kkt(contestants_.size());
    for (std::size_t k = 0; k < contestants_.size(); ++k) {
      Performance& row = report_.rows[k];
      const BoxQpSolution& answer = contestants_[k].answer;
      row.time.push_back(contestants_[k].time);
      row.iterations += answer.iterations;
      if (answer.status != SolveStatus::solved) {
        ++row.failures;
        tell(qp, row, answer);
        continue;
      }
      kkt[k] = kkt_residuals(qp.box, answer.x).worst();
      row.kkt = std::max(row.kkt, kkt[k]);
      solved.push_back(k);
    }
    std::stable_sort(solved.begin(), solved.end(),
                     [&](std::size_t a, std::size_t b) { return kkt[a] < kkt[b]; });
    if (solved.empty()) {
      return;
    }
    QpReference reference = qp.primal ? QpReference(*qp.primal) : QpReference(qp.box);
    if (std::none_of(solved.begin(), solved.end(),
                     [&](std::size_t k) { return reference.solve(contestants_[k].answer.x); })) {
      ++report_.without_reference;
      return;
    }
    for (const std::size_t k : solved) {
      VelocityError& worst = report_.rows[k].velocity;
      const VelocityError error = reference.error(contestants_[k].answer.x);
      worst.norm = std::max(worst.norm, error.norm);
      worst.relative = std::max(worst.relative, error.relative);
      worst.largest = std::max(worst.largest, error.largest);
      worst.largest_relative = std::max(worst.largest_relative, error.largest_relative);
    }
  }

  void tell(const StoredQp& qp, const Performance& row, const BoxQpSolution& answer) {
    if (report_.failures.size() < failures_told) {
      report_.failures.push_back(fmt::format(
          "{}: {}, {}: {}{}", qp.group, row.back_end.name, row.warm ? "warm" : "cold",
          status_name(answer.status), answer.message.empty() ? "" : " (" + answer.message + ")"));
    }
  }

  int repeat_;
  std::vector<Contestant> contestants_;
  QpReport report_;
};

}  // namespace

std::vector<std::string> measured_back_ends() {
  std::vector<std::string> names = box_qp_solver_names();
  names.emplace_back(unpolished);
  return names;
}

QpReport measure(const QpSetReader& set, const std::vector<BackEnd>& back_ends, int repeat) {
  Contest contest(back_ends, repeat);
  StoredQp before;
  for (std::size_t i = 0; i < set.size(); ++i) {
    StoredQp qp = set.read(i);
    contest.take(qp, i > 0 ? &before : nullptr);
    before = std::move(qp);
  }
  return contest.report();
}

double quantile(std::vector<double> values, double share) {
  const auto rank =
      static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto at = values.begin() + std::max<std::ptrdiff_t>(rank - 1, 0);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace hagfish
