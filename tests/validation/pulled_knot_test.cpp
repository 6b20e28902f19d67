// The animal's own overhand knot, pulled tight by its tail: thickness locks it, and the tightest
// open trefoil in a rope takes up about ten diameters of it (Pieranski, Przybyl, Stasiak, "Tight
// open knots", Eur. Phys. J. E 6, 2001).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/knot/knot.hpp"
#include "experiments/mechanics/mechanics.hpp"
#include "tests/support/chain_runs.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::pulled_knot_test {

constexpr double look = 0.02;      // s, between looks at the knot's type
constexpr double averaging = 0.1;  // s: contacts flicker from step to step
constexpr double touching = 0.05;  // cm: gaps of the knot's contacts
constexpr double ideal = 10;       // shortening of the tightest open trefoil, diameters

/// The Table 1 run's knot as it starts to slide, some 13 diameters of shortening.
ChainRun tied_knot(const ResolvedScene& resolved) {
  ChainRun run(make_hagfish(resolved.specimen, resolved.scene), resolved.scene);
  for (const StoredState& stored : stored_states()) {
    if (stored.name == "slide") {
      run.state = stored.state;
      return run;
    }
  }
  throw std::runtime_error("no stored state \"slide\"");
}

/// Arc length between the head's tip and the last body's centre less their distance, cm.
double shortening(const ChainRun& run) {
  const Kinematics& kin = run.seen.kin;
  return run.model.length() - 0.5 * run.model.bodies.back().length -
         (kin.centre.rightCols<1>() - kin.origin.col(0)).norm();
}

/// Mean diameter of the skin from the knot's first contact to its last, cm; 0 without contacts.
double knot_diameter(const ChainRun& run) {
  int first = run.model.body_count();
  int last = -1;
  for (const Contact& contact : run.seen.contact.contacts) {
    if (contact.gap < touching) {
      first = std::min(first, contact.body_a());
      last = std::max(last, contact.body_b());
    }
  }
  double sum = 0;
  for (int b = first; b <= last; ++b) {
    sum += 2 * run.model.bodies[b].radius;
  }
  return sum / (last - first + 1);
}

/// What one pull leaves.
struct Pull {
  double shortening = 0;   ///< mean of its last 0.1 s, cm
  double diameters = 0;    ///< the same over the knot's mean diameter
  double before = 0;       ///< diameters in the 0.1 s before those
  double penetration = 0;  ///< worst of all its steps, cm
};

/// Pulls on for `duration` (s) with `force` (dyn), away from the head plate.
Pull pull(ChainRun& run, double force, double duration) {
  const double h = run.scene.time.step;
  const ExpectSettings& expect = run.scene.expect;
  const int steps = static_cast<int>(std::lround(duration / h));
  const int averaged = static_cast<int>(std::lround(averaging / h));
  TipForce tip;
  tip.value.x() = force;
  Pull result;
  for (int k = 0; k < steps; ++k) {
    run.step(tip);
    if (k >= steps - averaged) {
      result.shortening += shortening(run) / averaged;
      result.diameters += shortening(run) / knot_diameter(run) / averaged;
    } else if (k >= steps - 2 * averaged) {
      result.before += shortening(run) / knot_diameter(run) / averaged;
    }
    if (k % std::lround(look / h) == 0) {
      EXPECT_EQ(knot_name(knot_type(run.seen.kin.centre, {.votes = 9, .seed = 1}).type), "3_1")
          << "step " << k;
    }
    result.penetration = std::max(result.penetration, run.seen.penetration);
    EXPECT_LE(run.last.kkt.worst(), expect.kkt);
    EXPECT_LE(run.last.stationarity, 1e-9);
    EXPECT_LE(run.seen.limit_violation, expect.limit_violation);
    EXPECT_LE(head_drift(run.model, run.seen.kin), expect.head_drift);
  }
  return result;
}

TEST(PulledKnot, LocksAtTheIdealTrefoil) {
  const ResolvedScene resolved = stored_scene();
  ChainRun run = tied_knot(resolved);
  double looser = std::numeric_limits<double>::infinity();
  // The drag lets the knot close within 0.8 s at 500 dyn; then each rise only settles it.
  for (const auto& [force, duration] : {std::pair{500.0, 1.2}, {2000.0, 0.6}, {10000.0, 0.6}}) {
    SCOPED_TRACE(force);
    const Pull knot = pull(run, force, duration);
    // 0.7: 0.4, 0.3 and 0.2 above were measured, with or without bending limits and stiffness (the
    // body tapers and is a chain, not a rope), and a contact that comes or goes at the knot's end
    // moves the mean diameter by up to 1.5 %, 0.15.
    EXPECT_NEAR(knot.diameters, ideal, 0.7);
    // A knot that still closes at 500 dyn moves by 0.3 in that time; the flicker leaves 0.05.
    EXPECT_NEAR(knot.diameters, knot.before, 0.15);
    EXPECT_LT(knot.shortening, looser);
    // Twice the 0.0014 of the jolt to 10000 dyn, where rows that are linear over a step of 2 ms let
    // the strands overlap by terms in h^2 (0.0004 at 1 ms); 0.0002 at the lesser forces.
    EXPECT_LE(knot.penetration, 0.003);
    looser = knot.shortening;
  }
}

/// Of a rope, a chain of uniform girth without stiffness: diameters, without the error that falls
/// with the square of the link.
double rope_shortening(const std::string& type) {
  double coarse = 0;
  double fine = 0;
  for (auto& [link, shortening] : {std::pair<double, double&>{0.2, coarse}, {0.14, fine}}) {
    const TightKnot knot = tighten(type, link);
    EXPECT_EQ(knot.type, type);
    EXPECT_TRUE(knot.at_rest);
    shortening = knot.shortening;
  }
  return fine - (coarse - fine) * 0.14 * 0.14 / (0.2 * 0.2 - 0.14 * 0.14);
}

TEST(PulledKnot, RopesLockAtTheTightestOpenKnots) {
  // 10.1: published (Pieranski, Przybyl, Stasiak 2001). 13.70: an independent rope code. 0.5 %:
  // what is left of 10.095 and 13.711 here, and of the two codes' difference, is under 0.2 %.
  EXPECT_NEAR(rope_shortening("3_1"), 10.1, 0.05);
  EXPECT_NEAR(rope_shortening("4_1"), 13.70, 0.07);
}

}  // namespace hagfish::pulled_knot_test
