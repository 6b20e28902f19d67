// `hagfish check`: passes a log of the sliding phase, and names what was tampered with.
#include "experiments/audit/audit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/log/hdf5/hdf5_writer.hpp"
#include "core/step/rows/eq6_rows.hpp"
#include "experiments/audit/audit_parts.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_test {

namespace fs = std::filesystem;

class AuditTest : public testing::Test {
 protected:
  explicit AuditTest(const std::vector<std::string>& more = {}) {
    // The excerpt is of 13.76 to 13.82 s.
    std::vector<std::string> overrides = {"time.frame_interval=0.01", "expect.hand=right",
                                          "expect.types=[['3_1', 13, 14]]"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    SceneRun run(stored_scene(overrides));
    StoredState stored = stored_state("slide");
    stored.state = within_cones(run.model, stored.state);
    run.sim = resume(run.model, run.scene, stored, "ipopt");
    write_log(file, run, 30);
  }

  bool passes(const std::string& name) const {
    for (const Finding& finding : audit(file)) {
      if (finding.name == name) {
        return finding.passed;
      }
    }
    ADD_FAILURE() << "no finding named " << name;
    return false;
  }

  /// Adds `change` to one number of a dataset of doubles.
  void tamper(const std::string& path, std::size_t index, double change) const {
    rewrite<double>(file, path, H5::PredType::NATIVE_DOUBLE,
                    [&](std::vector<double>& values) { values.at(index) += change; });
  }

  TemporaryFolder folder;
  const fs::path file = folder / "log.h5";
};

TEST_F(AuditTest, PassesAnHonestLog) {
  for (const char* name : {"status", "knot held", "knot through time", "hand", "Eq. 6",
                           "penetration", "limits", "head drift", "KKT residual", "force balance",
                           "f_thigmo past the knot", "energy ledger", "energy gain"}) {
    EXPECT_TRUE(passes(name)) << name;
  }
  // The excerpt starts knotted and does not slide 9 cm: that must show.
  EXPECT_FALSE(passes("unknot at start"));
  EXPECT_FALSE(passes("slide"));
}

// Each is a thousandth of the force that slides the knot, or less.
TEST_F(AuditTest, MujocoMissesAForceThatWasChanged) {
  EXPECT_TRUE(passes("forward-inverse"));
  for (const char* block : {"thigmotaxis", "contact", "limit", "head"}) {
    const std::string path = std::string("/forces/") + block;
    tamper(path, 60, 0.1);
    EXPECT_FALSE(passes("forward-inverse")) << block;
    tamper(path, 60, -0.1);
  }
  tamper("/forces/tip", 0, 0.1);
  EXPECT_FALSE(passes("forward-inverse"));
}

TEST_F(AuditTest, RefusesAModelThatIsNotTheScenes) {
  const auto refusal = [this] { return audit_objections(file); };
  tamper("/model/mass", 17, 0.25);
  EXPECT_EQ(refusal().rfind(file.string() + ": /model/mass of body 17 is ", 0), 0u) << refusal();
  tamper("/model/mass", 17, -0.25);
  tamper("/model/limit_upper", root_dofs + 4, 0.25);
  EXPECT_NE(refusal().find("/model/limit_upper of hinge 4 is "), std::string::npos) << refusal();
  tamper("/model/limit_upper", root_dofs + 4, -0.25);
}

/// The same run with limits on the total angle of its joints.
class AuditOfCones : public AuditTest {
 protected:
  AuditOfCones() : AuditTest({"model.bending_limit=cone"}) {}
};

TEST_F(AuditOfCones, SeesABendPastItsCone) {
  EXPECT_TRUE(passes("limits"));
  EXPECT_TRUE(passes("forward-inverse"));
  EXPECT_TRUE(passes("force balance"));
  // As far about Y and Z as each alone might go.
  const Model model = cone_hagfish();
  const BendingCone& cone = model.cones.back();
  const Hdf5Reader::Rows q = Hdf5Reader(file).rows("/trajectory/q");
  for (const int k : {cone.dof + 1, cone.dof + 2}) {
    tamper("/trajectory/q", k, 0.95 * cone.limit - q(0, k));
  }
  EXPECT_FALSE(passes("limits"));
}

TEST_F(AuditOfCones, RefusesALogOfOtherCones) {
  tamper("/model/bending_limit", 5, 0.25);
  const std::string refusal = audit_objections(file);
  EXPECT_NE(refusal.find("/model/bending_limit of joint 5 is "), std::string::npos) << refusal;
}

TEST_F(AuditTest, SeesContactsThatAreNone) {
  EXPECT_TRUE(passes("contacts followed"));
  const std::vector<hsize_t> shape = Hdf5Reader(file).shape("/thigmotaxis/spline_a");
  for (std::size_t k = 0; k < shape[0] * shape[1]; ++k) {
    tamper("/thigmotaxis/spline_a", k, 3);
  }
  EXPECT_FALSE(passes("contacts followed"));
}

TEST_F(AuditTest, SeesAMultiplierThatPulls) {
  const std::vector<double> lambda = Hdf5Reader(file).doubles("/thigmotaxis/lambda");
  tamper("/thigmotaxis/lambda", 0, -2 * lambda[0] - 1);
  EXPECT_FALSE(passes("shape of forces"));
}

TEST_F(AuditTest, SeesAForceBehindTheKnot) {
  const int last = static_cast<int>(Hdf5Reader(file).doubles("/thigmotaxis/spline_b")[1]) + 2;
  const Body next = stored_scene().model.bodies[last + 1];
  tamper("/forces/thigmotaxis", next.first_dof, 1e-12);
  EXPECT_FALSE(passes("f_thigmo past the knot"));
  tamper("/forces/thigmotaxis", next.first_dof, -1e-12);
  EXPECT_TRUE(passes("f_thigmo past the knot"));
}

// In the middle of its step a body has moved on from where the contact was found, here by a segment
// of the spline; the patch of contact then begins further out.
TEST(LastLoaded, IsTheLastBodyThatRowsLoad) {
  for (const char* patch : {"controller.contact_patch=0", "controller.contact_patch=1"}) {
    const auto [scene, specimen, model] = stored_scene({patch});
    const Observation seen = observe(model, stored_state("slide").state, scene);
    int further = 0;
    for (const int moved_on : {0, 1}) {
      for (const KnotEnd end : {KnotEnd::first, KnotEnd::last, KnotEnd::neither}) {
        const Contact& found = end == KnotEnd::first ? *seen.ends.first : *seen.ends.last;
        const Contact contact = contact_at(seen.segments, found.segment_a, found.t_a,
                                           found.segment_b - moved_on, found.t_b);
        const ThigmotaxisCommand command{.contact = contact, .speed = {1, 1}, .end = end};
        int last = 0;
        for (const Row& row : eq6_rows(model, seen.kin, seen.segments, command, scene)) {
          visit_forces(row, seen.kin, [&last](int body, const auto&, const auto&) {
            last = std::max(last, body);
          });
        }
        EXPECT_EQ(last_loaded(seen.segments, scene, contact, end), last) << patch;
        further += last > contact.segment_b + 2 ? 1 : 0;
      }
    }
    EXPECT_EQ(further > 0, scene.controller.contact_patch > 0);
  }
}

TEST_F(AuditTest, SeesEachFigureThatWasChanged) {
  const std::tuple<const char*, std::size_t, double, const char*> changes[] = {
      {"/steps/head_drift", 3, 1e-3, "head drift"},
      {"/steps/penetration", 3, 0.1, "penetration"},
      {"/steps/kkt", 3, 1e-6, "KKT residual"},
      {"/diagnostics/work_tip", 2, 50, "energy ledger"},
      {"/diagnostics/kinetic_energy", 2, 1e6, "energy gain"},  // erg; the bent body holds some 1e5
      {"/trajectory/q", 7 + 20, 0.5, "limits"},
      {"/forces/contact", 30, NAN, "force balance"},
      {"/diagnostics/work_tip", 1, NAN, "energy ledger"}};
  for (const auto& [path, index, change, finding] : changes) {
    tamper(path, index, change);
    EXPECT_FALSE(passes(finding)) << path;
  }
}

TEST_F(AuditTest, SeesAKnotThatCameUndone) {
  // One frame with the body pulled straight is enough.
  const Hdf5Reader::Rows q = Hdf5Reader(file).rows("/trajectory/q");
  for (Eigen::Index k = 7; k < q.cols(); ++k) {
    tamper("/trajectory/q", k, -q(0, k));
  }
  EXPECT_FALSE(passes("knot held"));
  EXPECT_FALSE(passes("knot through time"));
}

TEST_F(AuditTest, SeesTheMirrorImageOfTheKnotExpected) {
  // y to -y, of one frame: root y, turns about x and z.
  const Hdf5Reader::Rows q = Hdf5Reader(file).rows("/trajectory/q");
  const Model model = stored_scene().model;
  const auto reflect = [&](Eigen::Index k) { tamper("/trajectory/q", k, -2 * q(0, k)); };
  for (const Eigen::Index k : {1, 4, 6}) {
    reflect(k);
  }
  for (std::size_t k = 0; k < model.hinges.size(); ++k) {
    if (model.hinges[k].axis != Axis::y) {
      reflect(7 + static_cast<Eigen::Index>(k));
    }
  }
  EXPECT_TRUE(passes("knot held"));
  EXPECT_FALSE(passes("hand"));
}

}  // namespace hagfish::audit_test
