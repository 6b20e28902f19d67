// The audit of a run in which the tail is pulled against a pole: what the log says of the obstacle
// goes red when it is false.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/audit/logged_contacts.hpp"
#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_obstacles_test {

/// Logs in `file` how the tail is pulled against a pole, with `set`.
void log_pole(const std::filesystem::path& file, std::vector<std::string> set = {}) {
  set.insert(set.end(), {"obstacle=[{kind='strand', name='pole', radius=0.5, "
                         "points=[[40, -1.4, -5], [40, -1.4, 5]]}]",
                         "time.step=0.005", "time.duration=0.4", "knot.votes=5",
                         "expect.energy_loss=0.2",  // of so short a log with long steps
                         "expect.knot=", "expect.types=[]", "expect.slide_distance=0"});
  write_log(file, stored_scene(set));
}

TEST(AuditObstacles, EachFigureIsWatched) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.h5";
  log_pole(file);
  EXPECT_EQ(audit_objections(file), "");
  int pressed = 0;
  for (const LoggedContact& contact : logged_contacts(LogContents(file.string()))) {
    pressed += contact.obstacle == 1;
  }
  ASSERT_GT(pressed, 3);
  const auto less = every([](double v) { return 0.99 * v; });
  expect_watched(file, "/contacts/spline_a", less, {"/forces/wall"});
  expect_watched(file, "/contacts/force", less, {"/forces/wall"});
  const char* place = "/contacts/spline_obstacle";
  expect_watched(file, place, every([](double v) { return 0.9 * v; }), {"/forces/wall"});
  expect_watched(file, place, every([](double v) { return v + 1; }), {"/contacts"});
  for (const int other : {-1, 0, 2}) {  // the body itself, the head plate, none
    expect_watched<std::int64_t>(file, "/contacts/obstacle",
                                 every([=](std::int64_t) { return other; }), {"/contacts"});
  }
}

TEST(AuditOfFlesh, ForcesAndEnergyAreWatched) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.h5";
  log_pole(file, {"flesh.stiffness=1e5", "flesh.relaxation=0.015", "flesh.spacing=0.212"});
  EXPECT_EQ(audit_objections(file), "");
  for (const std::string path :
       {"/contacts/force", "/flesh/energy", "/flesh/overlap", "/flesh/pressure"}) {
    expect_watched(file, path, every([](double v) { return 1.05 * v; }), {path});
  }
}

TEST(AuditOfAHole, AHeadThatStaysInIsNotOut) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.h5";
  const std::vector<std::string> set = {
      "wall.present=false",
      "obstacle=[{kind='plane', name='face', point=[2, 0, 0], normal=[1, 0, 0], neck=40}]",
      "time.step=0.005", "time.duration=0.1", "knot.votes=5"};
  const auto objects = [&](const std::string& out_of) {
    std::vector<std::string> all = set;
    all.push_back("expect.out_of=" + out_of);
    write_log(file, stored_scene(all));
    return audit_objections(file).find("head out") != std::string::npos;
  };
  EXPECT_TRUE(objects("face"));
  EXPECT_FALSE(objects(""));
}

TEST(AuditOfAHole, AHeadThatTheAnimalLetGoOfWasNotPulledOut) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.h5";
  const auto objections = [&](const std::string& hold) {
    write_log(file, scene_argument("reflex_hole_overhand", {hold}));
    return audit_objections(file);
  };
  EXPECT_EQ(objections("food.hold=30"), "");
  EXPECT_NE(objections("food.hold=0.3").find("after the animal had let go"), std::string::npos);
}

}  // namespace hagfish::audit_obstacles_test
