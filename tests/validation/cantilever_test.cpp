#include <gtest/gtest.h>

#include <ostream>
#include <stdexcept>
#include <string>

#include "tests/support/chain_runs.hpp"

namespace hagfish {
namespace {

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

void PrintTo(const Elastica& elastica, std::ostream* out) {
  *out << "load " << elastica.load_number;
}

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

}  // namespace
}  // namespace hagfish
