// Activations that give torques: optimal by their own conditions, by hand where a pair is alone,
// and honest where muscles are too weak.
#include "core/muscle/activation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_chain.hpp"

namespace hagfish::activation_test {

class Activations : public testing::Test {
 protected:
  /// R F_max of muscle m at its joint's hinges.
  Eigen::VectorXd gives(int m) const {
    Eigen::VectorXd arm(model.bodies[model.muscles[m].body].dofs);
    moment_arms(model, kin, model.muscles[m], arm);
    return model.muscles[m].force * arm;
  }
  void solve(const Eigen::VectorXd& torque) { solver.solve(model, kin, torque, effort); }

  Model model = muscled_hagfish();
  Random random{1};
  State state = random_state(random, model, 0.4);
  Kinematics kin = kinematics(model, state);
  ActivationSolver solver;
  MuscleEffort effort;
};

TEST_F(Activations, AreTheLeastThatGiveTheTorque) {
  // dyn cm; the last is too much for some, the first less than rounding of the next
  for (const double size : {1e-12, 1e3, 1e5, 1e6}) {
    const Eigen::VectorXd torque = random_entries(random, model.nv(), size);
    solve(torque);
    Eigen::VectorXd given;
    muscle_torque(model, kin, effort.activation, given);
    EXPECT_NEAR((torque - given - effort.residual).tail(model.nv() - root_dofs).norm(), 0,
                1e-12 * size * model.nv());
    EXPECT_TRUE(effort.residual.head<root_dofs>().isZero(0));
    EXPECT_GE(effort.activation.minCoeff(), 0);
    EXPECT_LE(effort.activation.maxCoeff(), 1);
    // The gradient a - 2 w F R'r is 0 inside the box and points out of it at its ends.
    for (MuscleGroup g = muscle_group(model, 0); g.count > 0;
         g = muscle_group(model, g.first + g.count)) {
      const Body& body = model.bodies[model.muscles[g.first].body];
      double squares = 0;
      for (int m = g.first; m < g.first + g.count; ++m) squares += gives(m).squaredNorm();
      const double w = residual_weight / squares;
      for (int m = g.first; m < g.first + g.count; ++m) {
        const double a = effort.activation[m];
        const double slope =
            a - 2 * w * gives(m).dot(effort.residual.segment(body.first_dof, body.dofs));
        // The back end's KKT residual is at most 1e-8 of the largest right-hand side, brought to
        // unit diagonal.
        EXPECT_GE(a < 1 ? slope : 0, -1e-7) << model.muscles[m].name;
        EXPECT_LE(a > 0 ? slope : 0, 1e-7) << model.muscles[m].name;
      }
    }
    if (size == 1e3) {
      EXPECT_LT(effort.residual.lpNorm<Eigen::Infinity>(), 1e-4 * size);
    } else if (size == 1e6) {
      EXPECT_GT(effort.residual.norm(), size);
    }
  }
}

TEST_F(Activations, RefuseWhatIsNoTorque) {
  Eigen::VectorXd torque = Eigen::VectorXd::Zero(model.nv());
  torque[20] = NAN;
  EXPECT_THROW(solve(torque), std::invalid_argument);
}

}  // namespace hagfish::activation_test
