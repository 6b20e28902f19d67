// The audit of a run by a law of its own, which cannot be made again: the rows that it asked for,
// and their forces, go red when they are false.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_law_test {

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

TEST(AuditLaw, OfTheRunsOwnEachFigureIsWatched) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.h5";
  SceneRun run = resumed(stored_state("slide"),
                         {"controller.law=own", "active.stiffness=100", "active.capacity=1e6",
                          "time.frame_interval=0.01", "knot.votes=5", "expect.types=[]"});
  run.sim.law = everything;
  write_log(file, run, 63);
  const std::string good = audit_objections(file);
  // The run is not whole; nothing else is wrong.
  for (const char* wrong : {"/eq6", "/control", "/forces", "/steps", "/thigmotaxis", "balance",
                            "inverse", "ledger", "cap", "asked", "muscles"}) {
    EXPECT_EQ(good.find(wrong), std::string::npos) << good;
  }
  const auto more = one([](double v) { return std::abs(v) > 1e-3 ? 1.01 * v : v; });
  expect_watched(file, "/eq6/lambda", more, {"/forces/thigmotaxis"});
  for (const char* path : {"/eq6/speed", "/eq6/spline_a", "/eq6/spline_b"}) {
    expect_watched(file, path, more, {"/eq6/speed"});
  }
  const auto far = [](double v) { return std::abs(v) > 1e-3 ? 50 * std::abs(v) : v; };
  expect_watched(file, "/eq6/command", one(far), {"thigmotaxis as asked"});
  expect_watched(file, "/eq6/cap", every([](double) { return 1e-3; }), {"thigmotaxis cap"});
  using Whole = std::int64_t;
  expect_watched<Whole>(file, "/eq6/along", one([](Whole) { return 1; }), {"/eq6/speed"});
  expect_watched<Whole>(file, "/eq6/towards", one([](Whole) { return -1; }), {"/eq6/speed"});
  expect_watched<Whole>(file, "/eq6/frame", one([](Whole v) { return v + 1; }), {"/eq6"});
  EXPECT_EQ(audit_objections(file), good);
}

}  // namespace hagfish::audit_law_test
