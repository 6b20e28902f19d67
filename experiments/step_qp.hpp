// The QP of a step, taken out of a run.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "core/simulation.hpp"
#include "experiments/qp_set.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// Hands problems on to another back end and remembers the last.
class RememberingSolver final : public BoxQpSolver {
 public:
  explicit RememberingSolver(std::unique_ptr<BoxQpSolver> solver) : solver_(std::move(solver)) {}
  using BoxQpSolver::solve;
  void solve(const BoxQp& qp, const Eigen::VectorXd& start, BoxQpSolution& solution) override;
  const BoxQp& problem() const { return problem_; }
  const Eigen::VectorXd& start() const { return start_; }

 private:
  std::unique_ptr<BoxQpSolver> solver_;
  BoxQp problem_;
  Eigen::VectorXd start_;
};

/// Whether a soft row's multiplier is at its upper bound: Eq. 4 with that row hard has another
/// solution then, and else the same.
bool at_cap(const StepSolution& solution);

/// The QP of the step as the paper's Eq. 4 has it, with soft rows as hard ones: H and g dense in q̇,
/// bilateral rows in G and e, all others in C and d, held ones too. qp.start is what `warm`, as the
/// step found it, keeps of their multipliers.
void to_primal(const Model& model, const StepRecord& record, const WarmStart& warm, StoredQp& qp);

}  // namespace hagfish
