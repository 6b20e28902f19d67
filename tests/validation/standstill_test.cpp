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

/// What the audit says of 300 steps from the scene's start, by `law`.
std::string objections(
    const ResolvedScene& resolved,
    const ControlLaw& law = [](const Situation&, Eigen::VectorXd&, Control&) {}) {
  const TemporaryFolder folder;
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  Simulation sim = start(model, resolved.scene, "active-set");
  sim.law = law;
  write_log(folder / "log.h5", resolved, model, sim, 300);
  return audit_objections(folder / "log.h5");
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

}  // namespace hagfish::standstill_test
