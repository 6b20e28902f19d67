// The audit of runs by other laws than the paper's: a log of a law of the run's own says what was
// asked for, and each of these figures goes red when it is false; one of a law that the scene names
// goes red where that law would have asked for something else.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>

#include "experiments/audit/audit.hpp"
#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_law_test {

namespace fs = std::filesystem;

ResolvedScene scene_of(const std::string& law, std::vector<std::string> set = {}) {
  set.insert(set.end(), {"controller.law=" + law, "active.stiffness=100", "active.capacity=1e6",
                         "time.frame_interval=0.01", "knot.votes=5", "expect.types=[]"});
  return stored_scene(set);
}

/// Asks for all that there is to ask for; some rows are held back.
void everything(const Situation& at, Eigen::VectorXd& /*memory*/, Control& control) {
  all_contacts_law(at, control);
  for (ThigmotaxisCommand& command : control.thigmotaxis) {
    command.speed.b -= 0.25;
    command.effort = command.end == KnotEnd::neither ? 0.02 : 0.5;
  }
  control.tip = {{10, -20, 30}, 2};
  const int nv = at.model.nv();
  control.torque.value = Eigen::VectorXd::LinSpaced(nv, -100, 200);
  control.torque.rate = Eigen::VectorXd::LinSpaced(nv, 1, 3);
  control.torque.value.head<root_dofs>().setZero();
  control.torque.rate.head<root_dofs>().setZero();
  control.rest_shape = Eigen::VectorXd::LinSpaced(nv, -0.05, 0.05);
  control.rest_shape.head<root_dofs>().setZero();
}

/// Logs of the stored slide, some steps long.
class AuditLaw : public testing::Test {
 protected:
  void write(const ResolvedScene& resolved, const ControlLaw& own) {
    const Model model = make_hagfish(resolved.specimen, resolved.scene);
    Simulation sim = resume(model, resolved.scene, stored_states().at(3));
    sim.law = own;
    write_log(file, resolved, model, sim, 63);
  }
  std::string objections() const { return audit_objections(file); }
  /// What the audit says while one entry, the first that `which` wants, is changed.
  template <class T>
  std::string objections_to(const std::string& path, const std::function<bool(T)>& which,
                            const std::function<T(T)>& change) {
    const auto type =
        std::is_same_v<T, double> ? H5::PredType::NATIVE_DOUBLE : H5::PredType::NATIVE_INT64;
    const auto before = rewrite<T>(file, path, type, [&](std::vector<T>& values) {
      const auto found = std::find_if(values.begin() + values.size() / 3, values.end(), which);
      ASSERT_NE(found, values.end()) << path;
      *found = change(*found);
    });
    const std::string text = objections();
    rewrite<T>(file, path, type, [&](std::vector<T>& values) { values = before; });
    return text;
  }

  TemporaryFolder folder;
  fs::path file = folder / "log.h5";
};

TEST_F(AuditLaw, OfTheRunsOwnEachFigureIsWatched) {
  write(scene_of("own"), everything);
  const std::string good = objections();
  // The run is not whole; nothing else is wrong.
  for (const char* wrong : {"/eq6", "/control", "/forces", "/steps", "/thigmotaxis", "balance",
                            "inverse", "ledger", "cap", "asked", "muscles"}) {
    EXPECT_EQ(good.find(wrong), std::string::npos) << good;
  }
  const std::map<std::string, std::string> numbers = {
      {"/control/tip", "/forces/tip"},
      {"/control/tip_rate", "/forces/tip"},
      {"/control/torque", "/forces/active"},
      {"/control/torque_rate", "/forces/active"},
      {"/trajectory/q_ref", "/forces/active"},
      {"/eq6/lambda", "/forces/thigmotaxis"},
      {"/eq6/speed", "/eq6/speed"},
      {"/eq6/slack", "/eq6/slack"},
      {"/eq6/spline_a", "/eq6/speed"},
      {"/eq6/spline_b", "/eq6/speed"},
      {"/thigmotaxis/command", "/thigmotaxis/command"},
      {"/thigmotaxis/cap", "/thigmotaxis/cap"}};
  const std::function<bool(double)> some = [](double v) { return std::abs(v) > 1e-3; };
  for (const auto& [path, watcher] : numbers) {
    const std::string text = objections_to<double>(path, some, [](double v) { return 1.01 * v; });
    EXPECT_NE(text.find(watcher), std::string::npos) << path << ": " << text;
  }
  // What is asked for binds or does not: it is seen where it would have bound otherwise.
  const std::string command =
      objections_to<double>("/eq6/command", some, [](double v) { return 50 * std::abs(v); });
  EXPECT_NE(command.find("/eq6/slack"), std::string::npos) << command;
  const auto bounds = rewrite<double>(file, "/eq6/cap", H5::PredType::NATIVE_DOUBLE,
                                      [](std::vector<double>& v) { v.assign(v.size(), 1e-3); });
  const std::string cap = objections();
  EXPECT_NE(cap.find("thigmotaxis cap"), std::string::npos) << cap;
  rewrite<double>(file, "/eq6/cap", H5::PredType::NATIVE_DOUBLE,
                  [&](std::vector<double>& v) { v = bounds; });

  using Whole = std::int64_t;
  const std::function<bool(Whole)> any = [](Whole) { return true; };
  const auto flipped = [&](const std::string& path, Whole from, Whole to) {
    return objections_to<Whole>(
        path, [from](Whole v) { return v == from; }, [to](Whole) { return to; });
  };
  const std::pair<std::string, std::string> flips[] = {
      {flipped("/control/clamp_head", 1, 0), "/forces/head"},
      {flipped("/control/has_rest_shape", 1, 0), "/forces/active"},
      {flipped("/eq6/along", 0, 1), "/eq6/speed"},
      {flipped("/eq6/towards", 1, -1), "/eq6/speed"},
      {flipped("/eq6/end", 0, 1), "/thigmotaxis/"},
      {objections_to<Whole>("/eq6/frame", any, [](Whole v) { return v + 1; }), "/eq6"}};
  for (const auto& [text, watcher] : flips) {
    EXPECT_NE(text.find(watcher), std::string::npos) << watcher << " in " << text;
  }
  EXPECT_EQ(objections(), good);
}

TEST_F(AuditLaw, OfANamedOneWhatItAsksForIsToo) {
  write(scene_of("all_contacts"), {});
  const std::string good = objections();
  EXPECT_EQ(good.find("forces of rows"), std::string::npos) << good;
  const auto some = [](double v) { return std::abs(v) > 1e-3; };
  for (const char* path : {"/eq6/command", "/eq6/cap"}) {
    const std::string text = objections_to<double>(path, some, [](double v) { return 1.01 * v; });
    EXPECT_NE(text.find(path), std::string::npos) << text;
  }
  const std::string faster =
      audit_objections_as(file, scene_of("all_contacts", {"controller.slide_head.a=3"}));
  EXPECT_NE(faster.find("/eq6/command"), std::string::npos) << faster;
  const std::string other = audit_objections_as(file, scene_of("paper"));
  EXPECT_NE(other.find("/forces/thigmotaxis"), std::string::npos) << other;
}

TEST_F(AuditLaw, OfTheKnotsSpeedAllRowsHaveOneScale) {
  const std::vector<std::string> loop = {
      "controller.knot_speed.target=2", "controller.knot_speed.gain=4",
      "controller.knot_speed.filter=0.05", "controller.knot_speed.most=3"};
  write(scene_of("knot_speed", loop), {});
  const std::string good = objections();
  EXPECT_EQ(good.find("forces of rows"), std::string::npos) << good;
  const std::string text = objections_to<double>(
      "/eq6/command", [](double v) { return v > 0.1; }, [](double v) { return 1.01 * v; });
  EXPECT_NE(text.find("/eq6/command"), std::string::npos) << text;
}

TEST_F(AuditLaw, OfAReducedBasisTorquesAreItsShapesTimesItsNumbers) {
  write(scene_of("reduced_basis",
                 {"controller.reduced_basis.cosines=3", "controller.reduced_basis.margin=1",
                  "controller.reduced_basis.period=0.01", "controller.reduced_basis.softness=0.1",
                  "controller.reduced_basis.most=1e4"}),
        {});
  const std::string good = objections();
  for (const char* wrong : {"forces of rows", "muscles", "balance", "cap"}) {
    EXPECT_EQ(good.find(wrong), std::string::npos) << good;
  }
  for (const char* path : {"/basis/amplitude", "/basis/window"}) {
    const std::string text = objections_to<double>(
        path, [](double v) { return std::abs(v) > 1e-3; }, [](double v) { return 1.01 * v; });
    EXPECT_NE(text.find("/forces/active"), std::string::npos) << path << ": " << text;
  }
  const std::string capped = objections_to<double>(
      "/eq6/cap", [](double v) { return v == 0; }, [](double) { return 1.0; });
  EXPECT_NE(capped.find("/eq6/cap"), std::string::npos) << capped;
}

/// Of the reflex the rest shape is what it copies, whatever its senses are.
TEST_F(AuditLaw, OfTheReflexTheRestShapeIsWhatItCopies) {
  const std::vector<std::string> senses[] = {
      {},
      {"controller.reflex.noise=0.2", "controller.reflex.gate=touch", "controller.reflex.reach=3"},
      {"controller.reflex.noise=0.2", "controller.reflex.delay=0.02"}};
  for (std::vector<std::string> set : senses) {
    set.insert(set.end(), {"controller.reflex.shift=0.1", "active.relax_time=1"});
    write(scene_of("reflex", set), {});
    const std::string good = objections();
    for (const char* wrong : {"muscles", "balance", "/forces", "/trajectory"}) {
      EXPECT_EQ(good.find(wrong), std::string::npos) << good;
    }
    const auto some = [](double v) { return std::abs(v) > 1e-3; };
    const std::string text =
        objections_to<double>("/trajectory/q_ref", some, [](double v) { return 1.001 * v; });
    EXPECT_NE(text.find("/trajectory/q_ref"), std::string::npos) << text;
    const std::string other =
        audit_objections_as(file, scene_of("reflex", [&] {
                              set.insert(set.begin() + static_cast<std::ptrdiff_t>(set.size()) - 2,
                                         "controller.reflex.seed=2");
                              set.emplace_back("controller.reflex.shift=0.11");
                              return set;
                            }()));
    EXPECT_NE(other.find("/trajectory/q_ref"), std::string::npos) << other;
  }
  // The last log is one of late senses.
  const std::string text = objections_to<double>(
      "/reflex/sensed", [](double v) { return std::abs(v) > 1e-3; },
      [](double v) { return 1.01 * v; });
  EXPECT_NE(text.find("/trajectory/q_ref"), std::string::npos) << text;
}

}  // namespace hagfish::audit_law_test
