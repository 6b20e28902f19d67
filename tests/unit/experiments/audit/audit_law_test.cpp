// The audit of a run by a law of its own, which cannot be made again: the rows that it asked for,
// and their forces, go red when they are false.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

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
    return objections_while<T>(file, path, type, [&](std::vector<T>& values) {
      const auto found = std::find_if(values.begin() + values.size() / 3, values.end(), which);
      ASSERT_NE(found, values.end()) << path;
      *found = change(*found);
    });
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
  const std::map<std::string, std::string> numbers = {{"/eq6/lambda", "/forces/thigmotaxis"},
                                                      {"/eq6/speed", "/eq6/speed"},
                                                      {"/eq6/spline_a", "/eq6/speed"},
                                                      {"/eq6/spline_b", "/eq6/speed"}};
  const std::function<bool(double)> some = [](double v) { return std::abs(v) > 1e-3; };
  for (const auto& [path, watcher] : numbers) {
    const std::string text = objections_to<double>(path, some, [](double v) { return 1.01 * v; });
    EXPECT_NE(text.find(watcher), std::string::npos) << path << ": " << text;
  }
  const std::string command =
      objections_to<double>("/eq6/command", some, [](double v) { return 50 * std::abs(v); });
  EXPECT_NE(command.find("thigmotaxis as asked"), std::string::npos) << command;
  const std::string cap =
      objections_while(file, "/eq6/cap", [](std::vector<double>& v) { v.assign(v.size(), 1e-3); });
  EXPECT_NE(cap.find("thigmotaxis cap"), std::string::npos) << cap;

  using Whole = std::int64_t;
  const std::function<bool(Whole)> any = [](Whole) { return true; };
  const auto flipped = [&](const std::string& path, Whole from, Whole to) {
    return objections_to<Whole>(
        path, [from](Whole v) { return v == from; }, [to](Whole) { return to; });
  };
  const std::pair<std::string, std::string> flips[] = {
      {flipped("/eq6/along", 0, 1), "/eq6/speed"},
      {flipped("/eq6/towards", 1, -1), "/eq6/speed"},
      {objections_to<Whole>("/eq6/frame", any, [](Whole v) { return v + 1; }), "/eq6"}};
  for (const auto& [text, watcher] : flips) {
    EXPECT_NE(text.find(watcher), std::string::npos) << watcher << " in " << text;
  }
  EXPECT_EQ(objections(), good);
}

}  // namespace hagfish::audit_law_test
