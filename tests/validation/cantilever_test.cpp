#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/support/chain_runs.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::cantilever_test {

constexpr double length = 10;     // cm
constexpr double rigidity = 1e4;  // EI, dyn cm^2

/// Where the loaded tip of the cantilever comes to rest, over its length.
struct Tip {
  double across = 0;      ///< w / L, along the load
  double shortening = 0;  ///< u / L, lost along the clamp
};

/// A cantilever under a dead load at its tip, across it: cells of equal length with one spring
/// hinge each, of stiffness EI / cell, in the middle of the cell. The tip force acts on the centre
/// of the last body, which therefore reaches half a cell too far; nothing loads that end.
Tip rest_tip(double load_number, int cells) {
  const double cell = length / cells;
  const double stiffness = rigidity / cell;
  constexpr double relaxation = 0.05;  // s, of each hinge's own spring and damper
  Model model;
  append_root(model, cell / 2);
  for (int b = 0; b < cells; ++b) {
    append_body(model, thin_rod(1e-3 * cell, cell), {Axis::z});
    model.hinges.back().stiffness = stiffness;
    model.hinges.back().damping = relaxation * stiffness;
  }
  ChainRun run(model, bare_scene(relaxation / 10));

  TipForce load;
  load.value.y() = load_number * rigidity / (length * length);
  constexpr double still = 1e-9;  // rad/s of every hinge: 1e-10 rad from rest after `relaxation`
  do {
    run.step(load);
    if (run.time > 100 * relaxation) {
      throw std::runtime_error("the cantilever does not come to rest");
    }
  } while (run.state.qdot.lpNorm<Eigen::Infinity>() > still);
  const Eigen::Vector3d tip = run.centres().rightCols<1>();
  return {tip.y() / length, 1 - tip.x() / length};
}

struct Elastica {
  double load_number;  ///< P L^2 / EI
  Tip tip;
};

class Cantilever : public ::testing::TestWithParam<Elastica> {};

TEST_P(Cantilever, TipOfTheElastica) {
  const auto& [load, elastica] = GetParam();
  const Tip coarse = rest_tip(load, 10);
  const Tip middle = rest_tip(load, 20);
  const Tip fine = rest_tip(load, 40);
  for (double Tip::*part : {&Tip::across, &Tip::shortening}) {
    SCOPED_TRACE(part == &Tip::across ? "w / L" : "u / L");
    // Hinges in the middles of their cells are a midpoint rule: errors of 0.4 / cells^2 at most.
    EXPECT_NEAR(fine.*part, elastica.*part, 0.4 / (40 * 40));
    // The order shows in the differences alone: the references' five decimals would hide it. The
    // next term is of order 1 / cells^4.
    EXPECT_NEAR((coarse.*part - middle.*part) / (middle.*part - fine.*part), 4, 0.2);
    // Without the leading term the five decimals are left: half a unit of the last is 0.5e-5.
    EXPECT_NEAR((4 * (fine.*part) - middle.*part) / 3, elastica.*part, 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Loads, Cantilever,
    ::testing::Values(Elastica{1, {.30172, .05643}}, Elastica{2, {.49346, .16064}},
                      Elastica{5, {.71379, .38763}}, Elastica{10, {.81061, .55500}}),
    [](const auto& param) {
      return "load" + std::to_string(static_cast<int>(param.param.load_number));
    });

// The hagfish itself as a rod of constant EI = GJ, clamped at the head, under torques.

constexpr double fish_length = 42.4;   // cm
constexpr double fish_rigidity = 424;  // EI and GJ, dyn cm^2

/// At rest under `torque` (dyn cm, world axes) on the last body: the hinges give way until their
/// springs balance it. A fixed-point step, exact at once where one axis is loaded.
Kinematics balanced(const Model& fish, const Eigen::Vector3d& torque) {
  State state = rest_state(fish);
  Matrix6Xd wrench = Matrix6Xd::Zero(6, fish.body_count());
  wrench.topRows<3>().rightCols<1>() = torque;
  const Kinematics straight = kinematics(fish, state);
  const Eigen::VectorXd load = generalised_force(fish, straight, wrench);
  for (int k = root_dofs; k < fish.nv(); ++k) {
    state.q[k + 1] = load[k] / fish.hinges[k - root_dofs].stiffness;
  }
  Kinematics kin = kinematics(fish, state);
  const Eigen::VectorXd left =
      generalised_force(fish, kin, wrench) + stiffness_force(fish, state.q);
  // Rounding of the sum of a hundred torques.
  EXPECT_LT(left.tail(fish.nv() - root_dofs).lpNorm<Eigen::Infinity>(), 1e-12 * torque.norm());
  return kin;
}

TEST(HagfishRod, AMomentAtTheTailBendsItIntoACircleToSecondOrder) {
  const double radius = 20;  // cm, of the bent rod
  const Eigen::Vector2d centre(radius * std::sin(fish_length / radius),
                               radius * (1 - std::cos(fish_length / radius)));
  for (const Axis about : {Axis::y, Axis::z}) {
    const auto error = [&](int n) {
      const Model fish = table1_hagfish(n);
      Eigen::Vector3d moment = Eigen::Vector3d::Zero();
      moment[static_cast<int>(about)] = fish_rigidity / radius;
      const Kinematics kin = balanced(fish, moment);
      const Eigen::Vector3d along = kin.rotation.back().col(0);
      const double across = about == Axis::z ? along.y() : -along.z();
      // The direction of the tail is exact: the moment is the same everywhere.
      EXPECT_NEAR(along.x(), std::cos(fish_length / radius), 1e-13) << n;
      EXPECT_NEAR(across, std::sin(fish_length / radius), 1e-13) << n;
      const Eigen::Vector3d tip = kin.origin.rightCols<1>() + fish.bodies.back().length * along;
      return (Eigen::Vector2d(tip.x(), about == Axis::z ? tip.y() : -tip.z()) - centre).norm();
    };
    for (const int n : {20, 21, 50, 51}) {
      // Twice the joints, a quarter of the error; the next term is of order 1 / n^3 where n is odd.
      const int twice = n % 2 == 0 ? 2 * n : 2 * n - 1;
      const double finer = static_cast<double>(twice) / n;
      EXPECT_NEAR(error(n) / error(twice), finer * finer, n % 2 == 0 ? 0.02 : 0.5) << n;
    }
  }
}

}  // namespace hagfish::cantilever_test
