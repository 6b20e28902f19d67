// Impacts of a step of the midpoint rule, and the velocity after it (core/README.md, "Steps in
// time").
#pragma once

#include <vector>

#include "core/step/rounds.hpp"

namespace hagfish {

/// Finds them step by step, in storage that it keeps.
class Impacts {
 public:
  /// step.next and the impacts of step.rows, of a step that is solved at `place` by `problem`. Not
  /// ok (non_finite) where a held limit cannot be let go.
  Status set_next_velocity(const StepInput& in, const StepPlace& place, const RowProblem& problem,
                           StepSolution& step);

  /// Half of what steady forces changed the velocity by in that step, nv.
  const Eigen::VectorXd& half_change() const { return half_change_; }

 private:
  bool find(const StepInput& in, const StepPlace& place, StepSolution& step);
  void solve_hit(const RowProblem& problem, const StepSolution& step);
  void bound_hit(const StepPlace& place, const RowProblem& problem, StepSolution& step);
  void respond(const StepInput& in, const StepPlace& place, const ArticulatedFactor& factor,
               StepSolution& step);
  bool release_held(const StepPlace& place, StepSolution& step);
  double coupling(const RowProblem& problem, const StepSolution& step, Eigen::Index i,
                  std::size_t row) const;

  std::vector<std::size_t> held_;              ///< prescribed rows that push, and
  std::vector<PrescribedVelocity> jumps_;      ///< what their velocities change by
  std::vector<std::size_t> full_;              ///< rows at their upper bound
  std::vector<std::size_t> hit_;               ///< other rows with an impact
  std::vector<double> hit_A_, hit_b_, hit_x_;  ///< Eq. 4 of those, and its answer
  ArticulatedFactor free_factor_;              ///< with limits that would pull let go
  Eigen::VectorXd half_change_, impact_;       ///< of the velocity, nv
  Matrix6Xd impact_twist_;
  Eigen::Matrix3Xd impact_centre_velocity_;
  Matrix6Xd wrench_;  ///< of the impacts
  Eigen::VectorXd joint_, reaction_;
};

}  // namespace hagfish
