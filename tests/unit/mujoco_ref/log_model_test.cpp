// A log opens in MuJoCo and replays; of a model that is not the log's the first difference is
// named.
#include "mujoco_ref/log_model.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/chain/kinematics.hpp"
#include "core/log/hdf5_writer.hpp"
#include "mujoco_ref/mirror.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::log_model_test {

namespace fs = std::filesystem;

constexpr double h = 0.002;

std::map<std::string, std::string> files_of(const Model& model, Head head = Head::free) {
  return mjcf_files(model, table1_scene().contact.least_arc, h, head);
}

class LogModel : public testing::Test {
 protected:
  void write(const std::map<std::string, std::string>& files) const {
    Hdf5Writer h5;
    h5.group("/mjcf");
    for (const auto& [name, text] : files) h5.text("/mjcf/" + name, text);
    h5.save(file);
  }
  std::string error() const {
    return error_of<FileError>([this] { mujoco_model_of(Hdf5Reader(file)); });
  }

  TemporaryFolder folder;
  const fs::path file = folder / "log.h5";
};

TEST_F(LogModel, ReplaysPositions) {
  const Model model = table1_hagfish();
  write(files_of(model));
  MujocoModel mirror = mujoco_model_of(Hdf5Reader(file));
  Random random(1);
  const State state = random_state(random, model);
  set_state(model, state, mirror);
  mj_kinematics(mirror.model(), mirror.data());
  const Kinematics kin = kinematics(model, state);
  for (int b = 0; b < model.body_count(); ++b) {
    const Eigen::Vector3d centre(mirror.data()->xipos + 3 * (b + 1));
    EXPECT_LE((centre - kin.centre.col(b)).norm(), 1e-12 * model.length());  // rounding
  }
  const State back = state_of(model, mirror);
  EXPECT_EQ(back.q, state.q);
  EXPECT_EQ(back.qdot, state.qdot);
}

TEST_F(LogModel, NamesFileAndReason) {
  const auto files = files_of(table1_hagfish());
  auto without_root = files;
  without_root.erase(mjcf_root_file);
  write(without_root);
  EXPECT_EQ(error(), file.string() + ": has no /mjcf/hagfish.xml");
  auto broken = files;
  std::string& text = broken["hagfish_bodies_40.xml"];
  text = text.substr(0, text.size() / 2);
  write(broken);
  EXPECT_EQ(error().rfind(file.string() + ": /mjcf/hagfish_bodies_40.xml: XML parse error", 0), 0u)
      << error();
}

TEST(FirstDifference, IsNoneForTheSameModel) {
  for (const int bodies : {2, 3, 100, 400}) {
    const Model model = table1_hagfish(bodies);
    const MujocoModel mirror(files_of(model));
    EXPECT_EQ(first_difference(*mirror.model(), model, h), "");
    const Model cones = cone_hagfish(bodies);
    EXPECT_EQ(first_difference(*MujocoModel(files_of(cones)).model(), cones, h), "");
  }
}

TEST(FirstDifference, NamesEachQuantity) {
  const Model model = table1_hagfish(10);
  const MujocoModel mirror(files_of(model));
  const auto difference = [&](const auto& change, double step = h) {
    Model other = model;
    change(other);
    return first_difference(*mirror.model(), other, step);
  };
  const auto expect = [](const std::string& found, const std::string& start) {
    EXPECT_EQ(found.rfind(start, 0), 0u) << found;
  };
  expect(difference([](Model&) {}, 0.005), "timestep: 0.002");
  expect(difference([](Model& m) { m.bodies.pop_back(); }), "number of bodies: 10 against 9");
  expect(difference([](Model& m) { m.hinges.pop_back(); }), "number of velocities: ");
  expect(difference([](Model& m) { m.gravity.z() = -981; }), "gravity along z: ");
  expect(difference([](Model& m) { m.bodies[4].mass *= 1 + 1e-11; }), "mass of b4: ");
  expect(difference([](Model& m) { m.bodies[5].length *= 2; }), "length of b5: ");
  expect(difference([](Model& m) { m.bodies[6].inertia.y() *= 2; }), "inertia of b6 about y: ");
  expect(difference([](Model& m) { m.bodies[7].radius *= 2; }), "radius of b7: ");
  expect(difference([](Model& m) { m.hinges[0].axis = Axis::y; }), "joint 1: j01_bend_z");
  expect(difference([](Model& m) { m.hinges[1].lower = -1; }), "lower limit of j01_bend_y: ");
  expect(difference([](Model& m) { m.hinges[1].upper = 9; }), "upper limit of j01_bend_y: ");
  expect(difference([](Model& m) { m.hinges[2].stiffness += 1; }), "stiffness of j02_twist: ");
  expect(difference([](Model& m) { m.hinges[2].damping += 1; }), "damping of j02_twist: ");
}

}  // namespace hagfish::log_model_test
