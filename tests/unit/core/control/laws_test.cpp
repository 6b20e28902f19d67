// The table of control laws: each is found by its name, and what it works in is no part of a run.
#include "core/control/laws.hpp"

#include <stdexcept>
#include <string>

#include "core/input/scene_text.hpp"
#include "tests/support/errors.hpp"
#include "tests/unit/core/control/controller_fixture.hpp"

namespace hagfish::laws_test {

TEST(Laws, AreFoundByTheirNames) {
  Scene scene;
  for (const Law* law : laws()) {
    scene.controller.law = law->name;
    EXPECT_EQ(&law_of(scene), law);
    EXPECT_FALSE(law->description.empty());
    EXPECT_EQ(law->make == nullptr, law->name == own_law);
  }
  scene.controller.law = "mine";
  EXPECT_EQ(error_of<std::invalid_argument>([&] { law_of(scene); }),
            "no control law is called \"mine\"");
}

TEST(Laws, HaveTablesThatScenesHave) {
  const std::string text = scene_to_toml({}, Specimen());
  for (const Law* law : laws()) {
    const std::string heading = "[controller." + std::string(law->table) + "]";
    EXPECT_TRUE(law->table.empty() || text.find(heading) != std::string::npos) << law->name;
  }
}

struct Count {
  int asked = 0;
};

void count(const Situation& /*at*/, Eigen::VectorXd& memory, Control& /*control*/, Count& c) {
  memory = Eigen::VectorXd::Constant(1, ++c.asked);
}

class LawStorage : public ControllerTest {
 protected:
  double ask(const ControlLaw& law) {
    Eigen::VectorXd memory;
    Control control;
    law({model, scene, seen, now, state}, memory, control);
    return memory[0];
  }
};

TEST_F(LawStorage, IsKeptFromStepToStepAndEmptyInCopies) {
  const ControlLaw law = law_with_storage<Count, count>();
  EXPECT_EQ(ask(law), 1);
  EXPECT_EQ(ask(law), 2);
  const ControlLaw copy = law;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(ask(copy), 1);
  EXPECT_EQ(ask(law), 3);
}

TEST_F(LawStorage, IsOfTheLawThatTheSceneNamesNow) {
  observation.contact.contacts = {contact(5, 30)};
  start_in(Phase::slide);
  Control control;
  for (const char* law : {"paper", "all_contacts", "paper"}) {
    scene.controller.law = law;
    ask_law({model, scene, seen, now, state}, state.memory, control, named);
    EXPECT_EQ(named.law->name, law);
  }
}

}  // namespace hagfish::laws_test
