// A step works in storage that it keeps. The linker sends all requests for memory that come from
// the project's own code, Eigen included, through the two counters below (tests/CMakeLists.txt).
#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <optional>
#include <tuple>

#include "core/control/muscle_law.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"

namespace {
volatile int requests = 0;  // the compiler believes that malloc touches no such thing
}

// NOLINTBEGIN(bugprone-reserved-identifier): the linker's names
extern "C" {
void* __real_malloc(std::size_t size);
void* __wrap_malloc(std::size_t size) {
  requests = requests + 1;
  return __real_malloc(size);
}
void* __real__Znwm(std::size_t size);
void* __wrap__Znwm(std::size_t size) {
  requests = requests + 1;
  return __real__Znwm(size);
}
}
// NOLINTEND(bugprone-reserved-identifier)

namespace hagfish::allocation_test {

/// Steps a stored state; the controller does not look at the knot, which costs memory of its own.
class Allocation : public testing::Test, protected SceneRun {
 protected:
  Allocation() : SceneRun(stored_scene()) {}
  void slide(BendingLimit limit = BendingLimit::box) {
    scene.model.bending_limit = limit;
    scene.controller.contact_patch = 0;  // over a patch each row of Eq. 6 has a list of its own
    model = make_hagfish(specimen, scene);
    scene.knot.interval = std::numeric_limits<double>::infinity();
    StoredState stored = stored_state("slide");
    stored.state = within_cones(model, stored.state);
    sim = resume(model, scene, stored);
    sim.controller.knot_seen = 0;
  }
  /// Requests of one step.
  int step() {
    const int before = requests;
    SceneRun::step();
    return requests - before;
  }
};

TEST_F(Allocation, CountersSeeEigenAndTheStandardLibrary) {
  const auto size = static_cast<Eigen::Index>(scene.knot.votes);  // not known to the compiler
  const int before = requests;
  const Eigen::VectorXd vector = Eigen::VectorXd::Ones(size);
  volatile const double* used = vector.data();
  EXPECT_EQ(requests - before, 1) << *used;
  const int between = requests;
  const std::vector<double> other(vector.begin(), vector.end());
  EXPECT_EQ(requests - between, 1) << other.front();
}

TEST_F(Allocation, NoneInTheMuscleLawWhereItSolvesAStepAsItDidBefore) {
  scene.muscle = {true, 0.1};
  scene.script.kind = ScriptSettings::Kind::curvature;  // with tone
  scene.active = {500, 0.01, 1, 1e4};
  slide();
  std::optional<MuscleStorage> storage(std::in_place);
  Eigen::VectorXd memory;
  Control control;
  const auto asked_at = [&](double time) {
    control.thigmotaxis.clear();  // as a law finds them
    control.torque.value.setZero();
    control.torque.rate.setZero();
    const int before = requests;
    muscle_law({model, scene, sim.now, time, sim.controller}, memory, control, *storage);
    return requests - before;
  };
  // Arrays by row grow from round to round of one step: a moment with one round is looked for.
  for (int k = 0; k < 100 && storage->paper.step.rounds != 1; ++k) {
    step();
    memory.resize(0);
    control = {};
    storage.emplace();
    EXPECT_GT(asked_at(0), 0);
  }
  ASSERT_EQ(storage->paper.step.rounds, 1);
  asked_at(0.004);
  EXPECT_EQ(asked_at(0.008), 0);
  EXPECT_GT(control.torque.value.size(), 0);
}

class AllocationOfRows : public Allocation,
                         public testing::WithParamInterface<std::pair<BendingLimit, const char*>> {
};

TEST_P(AllocationOfRows, NoneInAStepWithAsManyRowsAsTheLastOne) {
  // Arrays by row keep their storage as long as the numbers of rows and of prescribed ones stay;
  // lists keep what they have grown to, so that the same steps, taken again, need no more.
  const auto [limit, law] = GetParam();
  scene.controller.law = law;
  scene.controller.knot_speed = {2, 1, 0.1, 2};
  slide(limit);
  for (int k = 0; k < 300; ++k) step();
  const Simulation middle = sim;
  for (int k = 0; k < 100; ++k) step();
  sim = middle;
  int compared = 0;
  for (int k = 0; k < 100; ++k) {
    const auto sizes = [&] {
      const StepSolution& last = record.solution;
      return std::tuple(last.rows.size(), last.prescribed, last.rounds);
    };
    const auto before = sizes();
    const int asked = step();
    if (sizes() == before && record.solution.rounds == 1) {
      EXPECT_EQ(asked, 0) << "step " << record.step;
      ++compared;
    }
  }
  EXPECT_GT(compared, 20);
}

INSTANTIATE_TEST_SUITE_P(BendingLimits, AllocationOfRows,
                         testing::Values(std::pair(BendingLimit::box, "paper"),
                                         std::pair(BendingLimit::cone, "paper"),
                                         std::pair(BendingLimit::box, "all_contacts"),
                                         std::pair(BendingLimit::box, "knot_speed")));

TEST_F(Allocation, NoneInAStepWithoutConstraints) {
  model.obstacles.clear();
  State state = rest_state(model);
  state.qdot[7] = 0.01;
  ControllerState controller;
  controller.phase = Phase::free;
  sim = start_from(model, scene, "active-set", state, controller, 0);
  for (int k = 0; k < 200; ++k) {
    const int asked = step();
    ASSERT_EQ(record.solution.kind, SolveKind::linear);
    if (k >= 10) {
      EXPECT_EQ(asked, 0) << "step " << record.step;
    }
  }
}

}  // namespace hagfish::allocation_test
