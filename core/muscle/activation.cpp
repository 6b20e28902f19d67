#include "core/muscle/activation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hagfish {

void ActivationSolver::solve(const Model& model, const Kinematics& kin,
                             const Eigen::VectorXd& torque, MuscleEffort& effort) {
  const auto all = model.muscle_count();
  effort.activation.resize(all);
  effort.residual = torque;
  effort.residual.head<root_dofs>().setZero();
  for (MuscleGroup group = muscle_group(model, 0); group.count > 0;
       group = muscle_group(model, group.first + group.count)) {
    const Body& body = model.bodies[model.muscles[group.first].body];
    auto& [solver, qp, solution, give] = joints_.at(group.count);
    give.resize(body.dofs, group.count);
    for (int m = 0; m < group.count; ++m) {
      const Muscle& muscle = model.muscles[group.first + m];
      moment_arms(model, kin, muscle, give.col(m));
      give.col(m) *= muscle.force;
    }
    const auto wanted = torque.segment(body.first_dof, body.dofs);
    const double size = give.squaredNorm();
    const double weight = size > 0 ? 2 * residual_weight / size : 0;
    qp.A.noalias() = weight * give.transpose() * give;
    qp.A.diagonal().array() += 1;
    qp.b.noalias() = weight * give.transpose() * wanted;
    qp.lower.setZero(group.count);
    // The objective at a = 0 is w |torque|^2, so no a is beyond this. Bounds that are far away on
    // the scale of a small torque would cost digits.
    qp.upper.setConstant(group.count, std::min(1.0, std::sqrt(weight) * wanted.norm()));
    solver.solve(qp, qp.lower, solution);
    if (solution.status != SolveStatus::solved) {
      throw std::logic_error("activations: " + solution.message);
    }
    effort.activation.segment(group.first, group.count) = solution.x;
    effort.residual.segment(body.first_dof, body.dofs).noalias() -= give * solution.x;
  }
}

}  // namespace hagfish
