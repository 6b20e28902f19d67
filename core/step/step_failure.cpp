// Why a step's problem could not be solved, in words.
#include <fmt/format.h>

#include <algorithm>

#include "core/step/rounds.hpp"

namespace hagfish {
namespace {

constexpr std::size_t most_named = 12;  ///< rows in a message

}  // namespace

Status describe_failure(const Model& model, const BoxQp& qp, const std::vector<Row>& rows,
                        const BoxQpSolution& solution) {
  if (solution.status == SolveStatus::stopped) {
    return {Outcome::stopped, fmt::format("stopped while solving for {} constraints", qp.b.size())};
  }
  std::vector<Eigen::Index> contradicting = solution.contradicting;
  if (contradicting.empty()) {
    const auto exact = make_box_qp_solver("active-set");
    contradicting = exact->solve(qp, Eigen::VectorXd::Zero(qp.b.size())).contradicting;
  }
  if (!contradicting.empty()) {
    std::string names;
    for (std::size_t k = 0; k < std::min(contradicting.size(), most_named); ++k) {
      names += (names.empty() ? "" : "; ") + row_name(model, rows[contradicting[k]]);
    }
    if (contradicting.size() > most_named) {
      names += fmt::format("; and {} more", contradicting.size() - most_named);
    }
    return {
        Outcome::infeasible,
        fmt::format("constraints contradict each other: {}; try a start without overlap, a lower "
                    "controller.cap or a smaller time.step",
                    names)};
  }
  Eigen::Index worst = 0;
  (qp.b - qp.A * solution.x).cwiseQuotient(row_scale(qp.A)).maxCoeff(&worst);
  return {Outcome::solver_failed,
          fmt::format("the QP solver failed ({}) on {} constraints, worst of all {}{}; try another "
                      "--qp or a smaller time.step",
                      status_name(solution.status), qp.b.size(), row_name(model, rows[worst]),
                      solution.message.empty() ? "" : fmt::format(" ({})", solution.message))};
}

}  // namespace hagfish
