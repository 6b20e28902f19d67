#include "core/muscle/activation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hagfish {

void ActivationSolver::solve(const Model& model, const Kinematics& kin,
                             const Eigen::VectorXd& torque, MuscleEffort& effort) {
  const auto all = static_cast<Eigen::Index>(model.muscles.size());
  effort.activation.resize(all);
  effort.residual = torque;
  effort.residual.head<root_dofs>().setZero();
  for (MuscleGroup group = muscle_group(model, 0); group.count > 0;
       group = muscle_group(model, group.first + group.count)) {
    const Body& body = model.bodies[model.muscles[group.first].body];
    give_.resize(body.dofs, group.count);
    for (int m = 0; m < group.count; ++m) {
      const Muscle& muscle = model.muscles[group.first + m];
      moment_arms(model, kin, muscle, give_.col(m));
      give_.col(m) *= muscle.force;
    }
    const auto wanted = torque.segment(body.first_dof, body.dofs);
    const double size = give_.squaredNorm();
    const double weight = size > 0 ? 2 * residual_weight / size : 0;
    qp_.A.noalias() = weight * give_.transpose() * give_;
    qp_.A.diagonal().array() += 1;
    qp_.b.noalias() = weight * give_.transpose() * wanted;
    qp_.lower.setZero(group.count);
    // The objective at a = 0 is w |torque|^2, so that no a is beyond this: bounds that are far away
    // on the scale of a small torque cost digits.
    qp_.upper.setConstant(group.count, std::min(1.0, std::sqrt(weight) * wanted.norm()));
    solver_.solve(qp_, qp_.lower, solution_);
    if (solution_.status != SolveStatus::solved) {
      throw std::logic_error("activations: " + solution_.message);
    }
    effort.activation.segment(group.first, group.count) = solution_.x;
    effort.residual.segment(body.first_dof, body.dofs).noalias() -= give_ * solution_.x;
  }
}

}  // namespace hagfish
