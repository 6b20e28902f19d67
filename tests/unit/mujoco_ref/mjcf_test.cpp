// The mirrored model must be the core's: same layout, same constants to the last bit, and the same
// kinematics, mass matrix and forces in random states.
#include "mujoco_ref/mjcf.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mujoco_ref/agreement.hpp"
#include "mujoco_ref/mujoco_model.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::mjcf_test {

constexpr double least_arc = 2.968;
constexpr double timestep = 0.002;
constexpr double infinity = std::numeric_limits<double>::infinity();

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// A hagfish with passive joints in gravity along no axis, so that no term is zero by chance.
Model hagfish(int bodies) {
  Scene scene = table1_scene(bodies);
  scene.model.bending_damping = 17;
  scene.model.twist_stiffness = 300;
  scene.model.twist_damping = 11;
  scene.gravity = {120, -350, -981};
  return make_hagfish(table1_specimen(), scene);
}

/// What a hagfish has not: bodies of different lengths and full inertia, joints with three hinges
/// or none, limits on one side or on none, a body without skin.
Model irregular() {
  Model model;
  model.gravity = {1.0 / 3, -2, 981};
  append_body(model, {.mass = 1.1, .length = 3, .radius = 0.5, .inertia = {1, 2, 2.5}}, {});
  append_body(model, {.mass = 0.7, .length = 0.3, .radius = 0.4, .inertia = {0.3, 0.2, 0.25}},
              {Axis::x, Axis::y, Axis::z});
  append_body(model, {.mass = 2.0 / 3, .length = 5, .radius = 0, .inertia = {0.1, 0.3, 0.35}}, {});
  append_body(model, {.mass = 0.2, .length = 1, .radius = 0.1, .inertia = {0.01, 0.02, 0.02}},
              {Axis::z, Axis::y});
  model.hinges[0].lower = -0.5;
  model.hinges[1].upper = 0.1;
  model.hinges[2].stiffness = 7;
  model.hinges[3].damping = 1.0 / 7;
  return model;
}

struct Case {
  std::string name;
  Model model;
};

/// Loads the case's model once a test; `forward` puts it into a state.
class Mirror : public testing::TestWithParam<Case> {
 protected:
  Mirror() : mujoco_(mjcf_files(model(), least_arc, timestep)) {}

  static const Model& model() { return GetParam().model; }

  /// All that MuJoCo computes of `state` short of contacts and limits.
  void forward(const State& state) {
    mujoco_.model()->opt.disableflags |= mjDSBL_CONSTRAINT;
    std::copy(state.q.begin(), state.q.end(), mujoco_.data()->qpos);
    std::copy(state.qdot.begin(), state.qdot.end(), mujoco_.data()->qvel);
    mj_forward(mujoco_.model(), mujoco_.data());
  }

  std::string name(mjtObj type, int id) { return mj_id2name(mujoco_.model(), type, id); }

  MujocoModel mujoco_;
};

TEST_P(Mirror, HasTheLayoutOfTheCore) {
  const mjModel& m = *mujoco_.model();
  ASSERT_EQ(m.nq, model().nq());
  ASSERT_EQ(m.nv, model().nv());
  ASSERT_EQ(m.nbody, 1 + model().body_count());
  ASSERT_EQ(m.njnt, 1 + static_cast<int>(model().hinges.size()));
  EXPECT_EQ(name(mjOBJ_JOINT, 0), "root");
  EXPECT_EQ(m.jnt_type[0], mjJNT_FREE);
  EXPECT_EQ(m.jnt_bodyid[0], 1);

  std::vector<std::string> names;
  for (const JointName& joint : joint_names(model())) {
    if (joint.joint != "root") names.insert(names.end(), joint.dofs.begin(), joint.dofs.end());
  }
  for (int k = 0; k < m.njnt - 1; ++k) {
    const Hinge& hinge = model().hinges[k];
    EXPECT_EQ(name(mjOBJ_JOINT, k + 1), names[k]);
    EXPECT_EQ(m.jnt_type[k + 1], mjJNT_HINGE);
    EXPECT_EQ(m.jnt_bodyid[k + 1], 1 + hinge.body);
    EXPECT_EQ(m.jnt_qposadr[k + 1], 7 + k);
    EXPECT_EQ(m.jnt_dofadr[k + 1], 6 + k);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(m.jnt_axis[3 * (k + 1) + i], i == static_cast<int>(hinge.axis));
    }
  }
  const Eigen::VectorXd rest = rest_state(model()).q;
  EXPECT_TRUE(std::equal(rest.begin(), rest.end(), m.qpos0));
}

// Masses, inertias, springs and dampers show in how it moves.
TEST_P(Mirror, HasTheStepAndTheLimitsOfTheCore) {
  const mjModel& m = *mujoco_.model();
  EXPECT_EQ(m.opt.timestep, timestep);
  for (int k = 0; k < m.njnt - 1; ++k) {
    const Hinge& hinge = model().hinges[k];
    const bool limited = hinge.lower > -infinity || hinge.upper < infinity;
    EXPECT_EQ(m.jnt_limited[k + 1] != 0, limited);
    EXPECT_EQ(m.jnt_range[2 * (k + 1)], hinge.lower);
    EXPECT_EQ(m.jnt_range[2 * (k + 1) + 1], hinge.upper);
    EXPECT_EQ(m.dof_frictionloss[k + 6], 0);
  }
}

TEST_P(Mirror, PutsTheSkinWhereTheCoreDoes) {
  Random random(1);
  for (int trial = 0; trial < 3; ++trial) {
    const State state = random_state(random, model(), 2, 5);
    const Kinematics kin = kinematics(model(), state);
    forward(state);
    const mjModel& m = *mujoco_.model();
    const mjData& d = *mujoco_.data();
    for (int b = 0; b < model().body_count(); ++b) {
      ASSERT_EQ(m.body_geomnum[b + 1], model().bodies[b].radius > 0 ? 1 : 0) << b;
    }
    for (int g = 0; g < m.ngeom; ++g) {
      const int b = m.geom_bodyid[g] - 1;
      SCOPED_TRACE(b);
      const Body& body = model().bodies[b];
      EXPECT_EQ(m.geom_type[g], mjGEOM_CAPSULE);
      EXPECT_EQ(m.geom_size[3 * g], body.radius);
      // MuJoCo halves a distance that it takes of two points: 4 ulp.
      EXPECT_DOUBLE_EQ(m.geom_size[3 * g + 1], body.length / 2);
      const Eigen::Vector3d centre(d.geom_xpos + 3 * g);
      const Eigen::Map<const RowMajor3d> rotation(d.geom_xmat + 9 * g);
      // Rounding: up to 400 turns, each good to some 1e-16, on positions of two body lengths.
      EXPECT_LE((centre - kin.centre.col(b)).norm(), 1e-12 * model().length());
      // A capsule lies along its own Z, either way round.
      EXPECT_LE(rotation.col(2).cross(kin.rotation[b].col(0)).norm(), 1e-12);
    }
  }
}

TEST_P(Mirror, MovesAsTheCoreDoes) {
  Random random(2);
  for (int trial = 0; trial < 3; ++trial) {
    const Agreement found = agreement(model(), random_state(random, model(), 2, 5), mujoco_);
    EXPECT_LE(found.position, agreement_bound.position);
    EXPECT_LE(found.orientation, agreement_bound.orientation);
    EXPECT_LE(found.mass, agreement_bound.mass);
    EXPECT_LE(found.bias, agreement_bound.bias);
    // The condition of M grows with the square of the number of bodies: the bound is for 100.
    const double bodies = std::max(1.0, model().body_count() / 100.0);
    EXPECT_LE(found.acceleration, acceleration_bound(found.condition) * bodies * bodies);
  }
}

// A clamped head is the world's: no root, and the rest of the layout as it is.
TEST_P(Mirror, HasNoRootWhereTheHeadIsClamped) {
  MujocoModel clamped(mjcf_files(model(), least_arc, timestep, Head::clamped));
  const mjModel& m = *clamped.model();
  EXPECT_EQ(m.nq, model().nq() - 7);
  EXPECT_EQ(m.nv, model().nv() - 6);
  ASSERT_EQ(m.nbody, 1 + model().body_count());
  EXPECT_EQ(m.body_dofnum[1], 0);
  for (int k = 0; k < m.njnt; ++k) {
    EXPECT_EQ(std::string(mj_id2name(&m, mjOBJ_JOINT, k)), name(mjOBJ_JOINT, k + 1));
  }
  mj_forward(clamped.model(), clamped.data());
  EXPECT_EQ(clamped.data()->ncon, 0) << "at rest";
}

TEST_P(Mirror, ExcludesTheContactsThatTheCoreIgnores) {
  std::set<std::pair<int, int>> expected;
  const int n = model().body_count();
  const auto front = [](int b) {
    double arc = 0;
    for (int k = 0; k < b; ++k) arc += model().bodies[k].length;
    return arc;
  };
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      // 1e-6: the core counts equal arcs as apart.
      if (front(b) - front(a + 1) < least_arc - 1e-6) expected.insert({a, b});
    }
  }
  const mjModel& m = *mujoco_.model();
  std::set<std::pair<int, int>> actual;
  for (int e = 0; e < m.nexclude; ++e) {
    const int signature = m.exclude_signature[e];  // (body1 + 1) << 16 + body2 + 1, world is 0
    const int a = (signature >> 16) - 2;
    const int b = (signature & 0xffff) - 2;
    actual.insert({std::min(a, b), std::max(a, b)});
  }
  EXPECT_EQ(actual, expected);
  mj_forward(mujoco_.model(), mujoco_.data());
  EXPECT_EQ(mujoco_.data()->ncon, 0) << "at rest";
}

INSTANTIATE_TEST_SUITE_P(Mjcf, Mirror,
                         testing::Values(Case{"bodies_2", hagfish(2)},
                                         Case{"bodies_101", hagfish(101)},
                                         Case{"irregular", irregular()}),
                         [](const auto& test) { return test.param.name; });

// A tail that meets the head in a pentagon: five corners of 72 degrees, one every second body.
TEST(Mjcf, SkinTouchesWithoutFriction) {
  Model model = hagfish(10);
  State state = rest_state(model);
  for (std::size_t k = 0; k < model.hinges.size(); ++k) {
    if (model.hinges[k].axis == Axis::z)
      state.q[7 + static_cast<Eigen::Index>(k)] = 2 * std::numbers::pi / 5;
  }
  MujocoModel mujoco(mjcf_files(model, least_arc, timestep));
  std::copy(state.q.begin(), state.q.end(), mujoco.data()->qpos);
  mj_forward(mujoco.model(), mujoco.data());
  ASSERT_GT(mujoco.data()->ncon, 0);
  for (int c = 0; c < mujoco.data()->ncon; ++c) {
    const mjContact& contact = mujoco.data()->contact[c];
    EXPECT_EQ(std::minmax(mujoco.model()->geom_bodyid[contact.geom1],
                          mujoco.model()->geom_bodyid[contact.geom2]),
              std::minmax(1, 10));
    EXPECT_EQ(contact.dim, 1);
  }
}

/// The error of loading `files`.
std::string load_error(const std::map<std::string, std::string>& files) {
  try {
    const MujocoModel mujoco(files);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::map<std::string, std::string> files_of_100() {
  return mjcf_files(hagfish(100), least_arc, timestep);
}

TEST(MujocoModel, NamesTheFileThatIsNotXml) {
  for (const auto& [name, text] : files_of_100()) {
    auto files = files_of_100();
    files[name] = text.substr(0, text.size() / 2);
    const std::string error = load_error(files);
    EXPECT_EQ(error.rfind(name + ": XML parse error", 0), 0u) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    files[name].clear();
    EXPECT_EQ(load_error(files), name + ": empty file");
  }
}

TEST(MujocoModel, PassesOnWhatMujocoRejectsInALine) {
  Model model = hagfish(2);
  model.hinges[1].lower = model.hinges[1].upper;
  const std::string error = load_error(mjcf_files(model, least_arc, timestep));
  EXPECT_NE(error.find("joint 'j01_bend_y'"), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

// As far as MuJoCo 2.2 reads one file: its bodies, springs and excludes are those of the files.
TEST(Mjcf, OneFileHoldsTheSameModel) {
  const auto files = mjcf_files(hagfish(96), least_arc, timestep);
  ASSERT_GT(files.size(), 3u);
  const MujocoModel of_files(files), of_one({{mjcf_root_file, flat_mjcf(files)}});
  const mjModel& a = *of_files.model();
  const mjModel& b = *of_one.model();
  std::vector<char> bytes[2];
  for (const mjModel* m : {&a, &b}) {
    std::vector<char>& of = bytes[m == &b];
    of.resize(static_cast<std::size_t>(mj_sizeModel(m)));
    mj_saveModel(m, nullptr, of.data(), static_cast<int>(of.size()));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(Mjcf, LeavesConesOutAndSaysSo) {
  Model model = hagfish(10);
  EXPECT_EQ(mjcf_files(model, least_arc, timestep).at(mjcf_root_file).find("Left out"),
            std::string::npos);
  for (const int k : {0, 1}) {
    model.hinges[k].lower = -infinity;
    model.hinges[k].upper = infinity;
  }
  model.cones.push_back({root_dofs, 0.5});
  const auto files = mjcf_files(model, least_arc, timestep);
  EXPECT_NE(files.at(mjcf_root_file).find("Left out: the limit on the total angle"),
            std::string::npos);
  const MujocoModel mujoco(files);
  EXPECT_EQ(std::string(mj_id2name(mujoco.model(), mjOBJ_JOINT, 1)), "j01_bend_z");
  EXPECT_FALSE(mujoco.model()->jnt_limited[1]);
  EXPECT_FALSE(mujoco.model()->jnt_limited[2]);
  EXPECT_TRUE(mujoco.model()->jnt_limited[3]);
}

TEST(Mjcf, ABallIsASphereAndAPoleIsCapsules) {
  Model model = hagfish(10);
  model.obstacles = {{"ball", Strand{{{3, 4, 5}}, 0.5}},
                     {"pole", Strand{{{1, 9, 0}, {2, 9, 0}}, 0.25}}};
  const MujocoModel mujoco(mjcf_files(model, least_arc, timestep));
  const mjModel& m = *mujoco.model();
  std::map<int, int> of_world;
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.geom_bodyid[g] != 0) continue;
    ++of_world[m.geom_type[g]];
    if (m.geom_type[g] != mjGEOM_SPHERE) continue;
    EXPECT_EQ(m.geom_size[3 * g], 0.5);
    EXPECT_EQ(Eigen::Vector3d::Map(m.geom_pos + 3 * g), Eigen::Vector3d(3, 4, 5));
  }
  EXPECT_EQ(of_world[mjGEOM_SPHERE], 1);
  EXPECT_EQ(of_world[mjGEOM_CAPSULE], 6);  // pieces of the pole's one segment
}

// MuJoCo drops what its buffers cannot hold. A tight knot of 100 bodies has up to 150 touching
// pairs (core/contact/contact.hpp), with two contacts in a pair at most.
TEST(Mjcf, HasRoomForTheContactsOfATightKnot) {
  const Model model = hagfish(100);
  const MujocoModel mujoco(mjcf_files(model, least_arc, timestep));
  EXPECT_GE(mujoco.model()->nconmax, 300);
  EXPECT_GE(mujoco.model()->njmax, 300 + static_cast<int>(model.hinges.size()));
}

// Overlapping neighbours are too many contacts for MuJoCo's buffer, of which it only warns.
TEST(MujocoModel, TakesWarningsAsErrors) {
  const std::string error = load_error(mjcf_files(hagfish(100), 0, timestep));
  EXPECT_EQ(error.rfind("hagfish.xml: Pre-allocated contact buffer is full", 0), 0u) << error;
}

}  // namespace hagfish::mjcf_test
