// Where nothing moves, or all moves alike, what an audit measures against vanishes: such logs pass.
#include <gtest/gtest.h>

#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::standstill_test {

/// The animal of Table 1 in a scene of its own, with all that its audit may object to.
ResolvedScene scene_of(std::vector<std::string> set) {
  set.insert(set.end(), {"expect.knot=", "expect.types=[]", "expect.speed_share=0.0",
                         "time.frame_interval=0.1", "controller.law=own"});
  return stored_scene(set);
}

/// What the audit says of so many steps from `sim`, by `law`; `sim` becomes their end.
std::string objections(const ResolvedScene& resolved, Simulation& sim, const ControlLaw& law,
                       int steps) {
  const TemporaryFolder folder;
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  sim.law = law;
  write_log(folder / "log.h5", resolved, model, sim, steps);
  StepRecord record;
  for (int k = 0; k < steps; ++k) take_step(model, resolved.scene, sim, record);
  return audit_objections(folder / "log.h5");
}

/// The same from the scene's own start.
std::string objections(
    const ResolvedScene& resolved,
    const ControlLaw& law = [](const Situation&, Eigen::VectorXd&, Control&) {}) {
  Simulation sim =
      start(make_hagfish(resolved.specimen, resolved.scene), resolved.scene, "active-set");
  return objections(resolved, sim, law, 300);
}

TEST(Standstill, OfAFreeBody) {
  EXPECT_EQ(objections(scene_of({"clamp_head=false", "wall.present=false"})), "");
}

TEST(Standstill, OfAClampedStraightBody) { EXPECT_EQ(objections(scene_of({})), ""); }

TEST(Standstill, OfFreeFall) {
  EXPECT_EQ(
      objections(scene_of({"clamp_head=false", "wall.present=false", "gravity=[0.0,0.0,-981.0]",
                           "drag.normal=0.0", "drag.tangential=0.0"})),
      "");
}

TEST(Standstill, OfABodyPulledStraight) {
  const ControlLaw pull = [](const Situation&, Eigen::VectorXd&, Control& control) {
    control.tip = {{500, 0, 0}, 0};
  };
  EXPECT_EQ(objections(scene_of({}), pull), "");
}

/// A knot in drag so large that it comes to rest in a second, held by muscles that pull towards the
/// shape that it had, and by no row of Eq. 6; then a log that begins with it at rest.
TEST(Standstill, OfAKnotHeldStill) {
  ResolvedScene resolved =
      scene_of({"active.stiffness=1e5", "active.capacity=1e7", "drag.normal=100.0",
                "drag.tangential=100.0", "start.phase=slide"});
  resolved.scene.expect.knot = "3_1";
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  const StoredState& slide = stored_states().at(3);
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(model.nv());
  shape.tail(model.nv() - root_dofs) = slide.state.q.tail(model.nv() - root_dofs);
  const ControlLaw hold = [&shape](const Situation&, Eigen::VectorXd&, Control& control) {
    control.rest_shape = shape;
  };
  Simulation sim = resume(model, resolved.scene, slide);
  EXPECT_EQ(objections(resolved, sim, hold, 5000), "");
  EXPECT_LT(sim.now.state.qdot.lpNorm<Eigen::Infinity>(), 1e-12);
  EXPECT_EQ(objections(resolved, sim, hold, 300), "");
}

}  // namespace hagfish::standstill_test
