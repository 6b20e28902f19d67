// Each phase of the Table 1 run for 0.1 s from a stored state: the run's own criteria at every
// step.
#include <gtest/gtest.h>

#include "core/log/log_frame.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::phases_test {

class Phases : public testing::TestWithParam<StoredState> {};

TEST_P(Phases, KeepTheirCriteriaAtEveryStep) {
  constexpr int steps = 50;
  const StoredState& stored = GetParam();
  const ResolvedScene resolved = stored_scene();
  const Scene& scene = resolved.scene;
  const Model model = make_hagfish(resolved.specimen, scene);
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

INSTANTIATE_TEST_SUITE_P(Table1, Phases, testing::ValuesIn(stored_states()), name_of);

}  // namespace hagfish::phases_test
