#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/chain_runs.hpp"

namespace hagfish::pendulum_test {

/// Period of a thin rod on one hinge, released at rest at `amplitude` (rad), over its period at
/// small amplitude, T0 = 2π sqrt(I / (m g d)).
double period_ratio(double amplitude) {
  constexpr double mass = 3;
  constexpr double length = 10;
  constexpr double gravity = 980;
  const double about_hinge = mass * length * length / 3;
  const double small =
      2 * std::numbers::pi * std::sqrt(about_hinge / (mass * gravity * length / 2));

  Model model;
  append_root(model, 0);
  append_body(model, thin_rod(mass, length), {Axis::y});
  model.gravity = {gravity, 0, 0};  // along the chain at rest: hanging is q = 0
  ChainRun run(model, bare_scene(small / 2000));
  run.state.q[7] = amplitude;
  return measured_period(
             run, [](const State& s) { return s.q[7]; }, 1) /
         small;
}

/// The references are given to 5 decimals: half a unit of the last one is 0.5e-5. On one hinge the
/// semi-implicit rule is leapfrog with a shifted velocity, so that its period errs by order
/// (2π / 2000)^2 / 24 = 4e-7 of T0, times 10 at 170 degrees, where the period depends steeply on
/// the energy.
constexpr double tolerance = 1e-5;

struct Swing {
  double degrees;
  double ratio;
};

class Pendulum : public ::testing::TestWithParam<Swing> {};

TEST_P(Pendulum, PeriodGrowsWithAmplitude) {
  const auto [degrees, ratio] = GetParam();
  EXPECT_NEAR(period_ratio(degrees * std::numbers::pi / 180), ratio, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Amplitudes, Pendulum,
                         ::testing::Values(Swing{10, 1.00191}, Swing{45, 1.03997},
                                           Swing{90, 1.18034}, Swing{170, 2.43936}),
                         [](const auto& param) {
                           return std::to_string(static_cast<int>(param.param.degrees)) + "deg";
                         });

}  // namespace hagfish::pendulum_test
