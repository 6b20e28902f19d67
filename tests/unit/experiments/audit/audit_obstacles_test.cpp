// The audit of a run in which the tail is pulled against a pole: what the log says of the obstacle
// goes red when it is false.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "experiments/audit/logged_contacts.hpp"
#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_obstacles_test {

class AuditObstacles : public testing::Test {
 protected:
  AuditObstacles() {
    write_log(file, stored_scene({"obstacle=[{kind='strand', name='pole', radius=0.5, "
                                  "points=[[40, -1.4, -5], [40, -1.4, 5]]}]",
                                  "time.step=0.005", "time.duration=0.4", "knot.votes=5",
                                  "expect.energy_loss=0.2",  // of so short a log with long steps
                                  "expect.knot=", "expect.types=[]", "expect.slide_distance=0"}));
  }
  template <class T>
  std::string objections_to(const std::string& path, const H5::DataType& type,
                            const std::function<T(T)>& change) {
    return objections_while<T>(file, path, type, [&](std::vector<T>& values) {
      ASSERT_FALSE(values.empty());
      for (T& value : values) value = change(value);
    });
  }

  TemporaryFolder folder;
  std::filesystem::path file = folder / "log.h5";
};

TEST_F(AuditObstacles, EachFigureIsWatched) {
  EXPECT_EQ(audit_objections(file), "");
  int pressed = 0;
  for (const LoggedContact& contact : logged_contacts(LogContents(file.string()))) {
    pressed += contact.obstacle == 1;
  }
  ASSERT_GT(pressed, 3);
  const auto number = [this](const std::string& path, const std::function<double(double)>& change) {
    return objections_to<double>(path, H5::PredType::NATIVE_DOUBLE, change);
  };
  for (const char* path : {"/contacts/spline_a", "/contacts/force"}) {
    const std::string text = number(path, [](double v) { return 0.99 * v; });
    EXPECT_NE(text.find("/forces/wall"), std::string::npos) << path << ": " << text;
  }
  const std::string place = number("/contacts/spline_obstacle", [](double v) { return 0.9 * v; });
  EXPECT_NE(place.find("/forces/wall"), std::string::npos) << place;
  const std::string beyond = number("/contacts/spline_obstacle", [](double v) { return v + 1; });
  EXPECT_NE(beyond.find("/contacts"), std::string::npos) << beyond;
  for (const int other : {-1, 0, 2}) {  // the body itself, the head plate, none
    const std::string text = objections_to<std::int64_t>(
        "/contacts/obstacle", H5::PredType::NATIVE_INT64, [&](std::int64_t) { return other; });
    EXPECT_NE(text.find("/contacts"), std::string::npos) << other << ": " << text;
  }
}

TEST(AuditOfFlesh, ForcesAndEnergyAreWatched) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.h5";
  write_log(file, stored_scene({"obstacle=[{kind='strand', name='pole', radius=0.5, "
                                "points=[[40, -1.4, -5], [40, -1.4, 5]]}]",
                                "flesh.stiffness=1e5", "flesh.relaxation=0.015",
                                "flesh.spacing=0.212", "time.step=0.005", "time.duration=0.4",
                                "knot.votes=5", "expect.energy_loss=0.2",
                                "expect.knot=", "expect.types=[]", "expect.slide_distance=0"}));
  EXPECT_EQ(audit_objections(file), "");
  for (const std::string path :
       {"/contacts/force", "/flesh/energy", "/flesh/overlap", "/flesh/pressure"}) {
    const std::string text = objections_while(file, path, [](std::vector<double>& values) {
      for (double& value : values) value *= 1.05;
    });
    EXPECT_NE(text.find(path), std::string::npos) << path;
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
    write_log(file, read_scene(HAGFISH_DATA_DIR "/reflex_hole_overhand.toml", {hold}));
    return audit_objections(file);
  };
  EXPECT_EQ(objections("food.hold=30"), "");
  EXPECT_NE(objections("food.hold=0.3").find("after the animal had let go"), std::string::npos);
}

}  // namespace hagfish::audit_obstacles_test
