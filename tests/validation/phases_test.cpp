// Each phase of the Table 1 run for 0.1 s from a stored state: the run's own criteria at every
// step, and the body where the run had it.
#include <gtest/gtest.h>

#include <numbers>

#include "core/log/log_frame.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::phases_test {

class Phases : public testing::TestWithParam<StoredState> {
 protected:
  static constexpr int steps = 50;
  ResolvedScene resolved = stored_scene();
  const Scene& scene = resolved.scene;
  Model model = make_hagfish(resolved.specimen, scene);
};

TEST_P(Phases, KeepTheirCriteriaAtEveryStep) {
  const StoredState& stored = GetParam();
  Simulation sim = resume(model, scene, stored, "ipopt");
  const bool knotted = stored.phase == Phase::tighten || stored.phase == Phase::slide;
  Worst worst;
  double balance = 0;
  int met = 0;
  for (int k = 0; k < steps; ++k) {
    const StepRecord record = take_step(model, scene, sim);
    worst.take(record);
    balance = std::max(balance, record.solution.stationarity);
    const ThigmotaxisRows rows =
        thigmotaxis_rows_of(record.control, record.solution, scene.time.step);
    EXPECT_EQ(rows.any, stored.phase != Phase::form && stored.phase != Phase::free);
    met += rows.met ? 1 : 0;
  }
  // Where another contact takes over, its rows need some steps up to their speed.
  if (stored.phase == Phase::slide) {
    EXPECT_GE(met, scene.expect.speed_share * steps);
  }
  if (knotted) {
    EXPECT_EQ(knot_name(sim.controller.knot.type), "3_1");
  }
  EXPECT_LE(worst.penetration, scene.expect.penetration);
  EXPECT_LE(worst.limit_violation, scene.expect.limit_violation);
  EXPECT_LE(worst.head_drift, scene.expect.head_drift);
  EXPECT_LE(worst.kkt, scene.expect.kkt);
  EXPECT_LE(balance, 1e-9);
  // Rounding of 50 booked steps.
  const EnergyLedger& ledger = sim.ledger;
  EXPECT_LE(std::abs(ledger.imbalance()),
            1e-11 * (std::abs(ledger.works()) + ledger.dissipated + ledger.initial));
}

TEST_P(Phases, GoWhereTheRunWent) {
  const StoredState& stored = GetParam();
  Simulation sim = resume(model, scene, stored, "ipopt");
  for (int k = 0; k < steps; ++k) {
    take_step(model, scene, sim);
  }
  const double off = (sim.now.observation.kin.centre - stored.later).colwise().norm().maxCoeff();
  // The controller forgets which contacts it used and for how long, so for up to the hysteresis
  // time (0.1 s) another pair may slide at 2 cm/s: half that way. Without contact rows: rounding,
  // grown in 50 steps.
  EXPECT_LE(off, stored.phase == Phase::form ? 1e-3 : 0.1);
}

INSTANTIATE_TEST_SUITE_P(Table1, Phases, testing::ValuesIn(stored_states()), name_of);

TEST(Sliding, ForceIsZeroBehindTheKnot) {
  const ResolvedScene resolved = stored_scene();
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  for (const StoredState& stored : stored_states()) {
    if (stored.phase != Phase::slide) {
      continue;
    }
    Simulation sim = resume(model, resolved.scene, stored, "ipopt");
    const StepRecord record = take_step(model, resolved.scene, sim);
    // The spline's four weights reach two bodies past the segment of the contact.
    const int last = record.controller.ends.last->segment_b + 2;
    const Body& behind = model.bodies[last + 1];
    const Eigen::VectorXd& force = record.solution.force[RowKind::thigmotaxis];
    EXPECT_EQ(force.tail(force.size() - behind.first_dof).lpNorm<Eigen::Infinity>(), 0);
    EXPECT_GT(force.head(behind.first_dof).lpNorm<Eigen::Infinity>(), 0);
  }
}

TEST(Determinism, TheSameStepsTwiceToTheLastBit) {
  const ResolvedScene resolved = stored_scene();
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  const auto run = [&] {
    Simulation sim = resume(model, resolved.scene, stored_states().at(3), "ipopt");
    for (int k = 0; k < 25; ++k) {
      take_step(model, resolved.scene, sim);
    }
    return sim.now.state;
  };
  const State once = run();
  const State twice = run();
  EXPECT_EQ(once.q, twice.q);
  EXPECT_EQ(once.qdot, twice.qdot);
}

}  // namespace hagfish::phases_test
