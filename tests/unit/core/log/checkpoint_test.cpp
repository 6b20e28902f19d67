// Checkpoints: a run goes on from its bytes as if nothing had been, and bytes that are not as they
// should be are refused.
#include "core/log/checkpoint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/log/hdf5_error.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::checkpoint_test {

struct Stage {
  Model model;
  Scene scene;
  Simulation sim;
  LogState log;

  void steps(int count) {
    for (int k = 0; k < count; ++k) {
      const StepRecord record = take_step(model, scene, sim);
      log.means.take(record, thigmotaxis_rows_of(record.control, record.solution, scene.time.step));
      log.worst.take(record);
    }
  }
  std::vector<std::uint8_t> bytes() const { return encode(sim, log); }
};

/// A run some steps after a stored state, its warm start and contact search in use.
Stage stage(const StoredState& stored, const std::string& back_end) {
  const ResolvedScene resolved = stored_scene();
  Model model = make_hagfish(resolved.specimen, resolved.scene);
  Simulation sim = resume(model, resolved.scene, stored, back_end);
  LogState log{RunningMeans(model.nv()), {}, "step 3 (t = 0.006 s): a warning"};
  Stage s{std::move(model), resolved.scene, std::move(sim), std::move(log)};
  s.steps(5);
  return s;
}

StoredState sliding() {
  for (const StoredState& stored : stored_states()) {
    if (stored.phase == Phase::slide) return stored;
  }
  throw std::runtime_error("no stored state slides");
}

class EveryPhase : public testing::TestWithParam<StoredState> {};

TEST_P(EveryPhase, TheRunGoesOnBitByBit) {
  for (const char* back_end : {"ipopt", "active-set"}) {
    Stage whole = stage(GetParam(), back_end);
    const std::vector<std::uint8_t> bytes = whole.bytes();
    LogState log{RunningMeans(whole.model.nv()), {}, {}};
    Simulation sim = decode(bytes, whole.model, back_end, log);
    Stage resumed{whole.model, whole.scene, std::move(sim), std::move(log)};
    EXPECT_EQ(resumed.bytes(), bytes);
    for (int k = 0; k < 10; ++k) {
      whole.steps(1);
      resumed.steps(1);
      // All that a step depends on or leaves, to the last bit.
      ASSERT_EQ(resumed.bytes(), whole.bytes()) << back_end << ", step " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(StoredStates, EveryPhase, testing::ValuesIn(stored_states()), name_of);

TEST(Checkpoint, KeepsThePullSoFar) {
  Stage s = stage(sliding(), "active-set");
  s.sim.controller.pull = {1234.5, 3};
  LogState log{RunningMeans(s.model.nv()), {}, {}};
  const Simulation again = decode(s.bytes(), s.model, "active-set", log);
  EXPECT_EQ(again.controller.pull.sum, 1234.5);
  EXPECT_EQ(again.controller.pull.steps, 3);
}

/// By a law that keeps `numbers` of its own: they are saved, and the run goes on to the last bit.
void expect_kept(const std::vector<std::string>& law, Eigen::Index numbers) {
  const ResolvedScene resolved = stored_scene(law);
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  Stage whole{model,
              resolved.scene,
              resume(model, resolved.scene, sliding()),
              {RunningMeans(model.nv()), {}, ""}};
  whole.steps(5);
  LogState log{RunningMeans(model.nv()), {}, {}};
  Simulation sim = decode(whole.bytes(), model, "active-set", log);
  ASSERT_EQ(sim.controller.memory.size(), numbers);
  EXPECT_EQ(sim.controller.memory, whole.sim.controller.memory);
  Stage resumed{model, resolved.scene, std::move(sim), std::move(log)};
  whole.steps(20);
  resumed.steps(20);
  EXPECT_EQ(resumed.bytes(), whole.bytes());
}

TEST(Checkpoint, KeepsTheMemoryOfTheControlLaw) {
  expect_kept({"controller.law=knot_speed", "controller.knot_speed.target=2",
               "controller.knot_speed.gain=3", "controller.knot_speed.filter=0.1",
               "controller.knot_speed.most=2"},
              2);
}

TEST(Checkpoint, ALawThatLooksForwardGoesOnToTheLastBit) {
  expect_kept({"controller.law=reduced_basis", "controller.reduced_basis.cosines=3",
               "controller.reduced_basis.period=0.01", "controller.reduced_basis.softness=0.1",
               "controller.reduced_basis.most=1e4"},
              3 + 2 * 9);
}

TEST(Checkpoint, KeepsWhatLateSensesShow) {
  expect_kept({"controller.law=reflex", "controller.reflex.shift=0.01",
               "controller.reflex.delay=0.02", "controller.reflex.noise=0.1",
               "active.stiffness=1e4", "active.relax_time=1", "active.capacity=1e6"},
              (0.02 / 0.002 + 1) * 149);
}

TEST(Checkpoint, KeepsActivations) {
  expect_kept({"controller.law=muscles", "muscle.present=true", "muscle.activation_time=0.1"},
              155 + 50 * 4 + 49 * 2);
}

// What it solves for itself must not depend on steps before, of which a checkpoint holds nothing.
TEST(Checkpoint, KeepsActivationsByTheMidpointRule) {
  expect_kept({"controller.law=muscles", "muscle.present=true", "muscle.activation_time=0.1",
               "time.rule=midpoint"},
              155 + 50 * 4 + 49 * 2);
}

class BadBytes : public testing::Test {
 protected:
  std::string refusal(const std::vector<std::uint8_t>& changed) {
    return error_of<FileError>([&] {
      LogState log{RunningMeans(s.model.nv()), {}, {}};
      decode(changed, s.model, "active-set", log);
    });
  }
  Stage s = stage(sliding(), "active-set");
  std::vector<std::uint8_t> bytes = s.bytes();
};

TEST_F(BadBytes, TooFewOrTooManyAreRefused) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{3}, std::size_t{100}, bytes.size() / 2, bytes.size() - 1}) {
    std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(refusal(cut), "no error") << size;
  }
  bytes.push_back(0);
  EXPECT_EQ(refusal(bytes), "checkpoint: does not end where it should");
}

TEST_F(BadBytes, AnotherLayoutOrAnotherAnimalIsRefused) {
  std::vector<std::uint8_t> other = bytes;
  ++other[0];
  EXPECT_EQ(refusal(other), "checkpoint: made by another version of the program");
  s.model = make_hagfish(stored_scene({"model.bodies=99"}).specimen,
                         stored_scene({"model.bodies=99"}).scene);
  EXPECT_EQ(refusal(bytes), "checkpoint: a state that is not of its model");
}

TEST_F(BadBytes, NeitherThereNorAbsentIsRefused) {
  ASSERT_TRUE(s.sim.controller.ends.last);
  s.sim.controller.ends.last.reset();
  const auto flag = std::ranges::mismatch(bytes, s.bytes()).in1;
  *flag = 199;
  EXPECT_EQ(refusal(bytes), "checkpoint: a flag is neither 0 nor 1");
}

TEST_F(BadBytes, NoChangeOfAByteLeadsOutOfBounds) {
  // Refused, or a run that a step does not crash: run under AddressSanitizer.
  std::mt19937 random(1);
  int refused = 0;
  for (int k = 0; k < 500; ++k) {
    std::vector<std::uint8_t> changed = bytes;
    // Half of them where counts and indices are dense: behind the state.
    const std::size_t state = 16 + 8 * (s.model.nq() + s.model.nv());
    const std::size_t from = k % 2 == 0 ? 0 : state;
    changed[from + random() % (changed.size() - from)] = static_cast<std::uint8_t>(random());
    try {
      LogState log{RunningMeans(s.model.nv()), {}, {}};
      Simulation sim = decode(changed, s.model, "active-set", log);
      take_step(s.model, s.scene, sim);
    } catch (const FileError&) {
      ++refused;
    } catch (const StepError&) {
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace hagfish::checkpoint_test
