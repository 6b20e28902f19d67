// Inverse dynamics put to the proof: the forces of each phase of the Table 1 run, given to MuJoCo
// as applied forces with its own contacts and limits off, must make the velocities of the run.
#include <gtest/gtest.h>

#include "core/chain/dynamics.hpp"
#include "mujoco_ref/forward_inverse.hpp"
#include "mujoco_ref/mirror.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::forward_inverse_test {

class ForwardInverse : public testing::TestWithParam<StoredState> {
 protected:
  static constexpr int steps = 50;

  /// Largest |Δq̇| over the largest |q̇| of `steps` steps; `spoil` may change the forces.
  double largest_error(const std::function<void(ConstraintForces&)>& spoil) {
    const ResolvedScene resolved = stored_scene({"model.bending_damping=17"});
    const Scene& scene = resolved.scene;
    const Model model = make_hagfish(resolved.specimen, scene);
    MujocoModel mirror(mjcf_files(model, scene.contact.least_arc, scene.time.step));
    use_core_rule(mirror);
    Simulation sim = resume(model, scene, GetParam(), "ipopt");
    double largest = 0;
    for (int k = 0; k < steps; ++k) {
      StepRecord record = take_step(model, scene, sim);
      const Eigen::VectorXd& next = record.solution.qdot;
      spoil(record.solution.force);
      const Eigen::VectorXd force =
          record.solution.force.total() + drag_force(model, record.after.observation.kin, next);
      const Eigen::VectorXd driven =
          driven_velocity(model, record.after.state, force, record.solution.tip, mirror);
      largest = std::max(
          largest, (driven - next).lpNorm<Eigen::Infinity>() / next.lpNorm<Eigen::Infinity>());
    }
    return largest;
  }
};

// Two factorisations of H, whose condition is some 1e6. Seen: 6e-11.
TEST_P(ForwardInverse, MakesTheVelocitiesOfTheRun) {
  EXPECT_LE(largest_error([](ConstraintForces&) {}), 1e-8);
}

// A thousandth of one block is missed.
TEST_P(ForwardInverse, NeedsEveryForce) {
  const StoredState& stored = GetParam();
  if (stored.phase == Phase::tighten || stored.phase == Phase::slide) {
    EXPECT_GT(largest_error([](ConstraintForces& f) { f[RowKind::thigmotaxis] *= 1.001; }), 1e-7);
    EXPECT_GT(largest_error([](ConstraintForces& f) { f[RowKind::contact] *= 1.001; }), 1e-7);
  }
  if (stored.phase < Phase::release) {  // the head is clamped
    EXPECT_GT(largest_error([](ConstraintForces& f) { f[RowKind::head] *= 1.001; }), 1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(Table1, ForwardInverse, testing::ValuesIn(stored_states()), name_of);

}  // namespace hagfish::forward_inverse_test
