// Flesh that yields against closed forms: two tubes that cross, a slit of two poles, a rope round a
// post, a body that bounces on a plane.
#include "core/contact/flesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "core/chain/start.hpp"
#include "core/control/control_law.hpp"
#include "experiments/mechanics/rod.hpp"
#include "tests/support/chain_runs.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/scene_run.hpp"

namespace hagfish::flesh_test {

constexpr double stiffness = 1e5;                         // dyn/cm^2: the animal's
constexpr FleshSettings animal{stiffness, 0.015, 0.212};  // the last two in s and cm
constexpr double radius = 0.87;                           // cm: the animal's
constexpr double force_tolerance = 0.01;                  // of normal forces, at any mesh

/// Curve of straight lines and arcs in the plane, that rises from 0 to `rise` between two lengths.
class Curve {
 public:
  void line(double way) {
    for (int i = 0; i < samples; ++i) add(way / samples, 0);
  }
  void arc(double around, double turn) {
    for (int i = 0; i < samples; ++i) add(around * std::abs(turn) / samples, turn / samples);
  }
  std::vector<Eigen::Vector3d> points{{0, 0, 0}};
  double length = 0;

 private:
  static constexpr int samples = 20000;
  void add(double step, double turn) {
    heading_ += 0.5 * turn;
    points.push_back(points.back() +
                     step * Eigen::Vector3d(std::cos(heading_), std::sin(heading_), 0));
    heading_ += 0.5 * turn;
    length += step;
  }
  double heading_ = 0;
};

/// Lifts the curve smoothly by `rise` between the shares `from` and `to` of its points.
void lift(double rise, double from, double to, std::vector<Eigen::Vector3d>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double along = static_cast<double>(i) / static_cast<double>(points.size());
    const double s = std::clamp((along - from) / (to - from), 0.0, 1.0);
    points[i].z() = rise * s * s * (3 - 2 * s);
  }
}

Scene flesh_scene(const FleshSettings& flesh, double least_arc) {
  Scene scene;
  scene.wall.present = false;
  scene.flesh = flesh;
  scene.contact.least_arc = least_arc;
  return scene;
}

Observation observed(const RodChain& chain, const Scene& scene) {
  return observe(chain.model, chain.state, scene);
}

class AtMeshes : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Flesh, AtMeshes, testing::Values(100, 200));

/// A tube whose end crosses over its begin at a right angle, `before` cm from its head.
RodChain crossing(double overlap, double before, int bodies) {
  Curve curve;
  curve.line(before);
  curve.arc(4, std::numbers::pi);
  curve.line(3);
  curve.arc(4, std::numbers::pi / 2);
  curve.line(9);
  lift(2 * radius - overlap, 0.3, 0.7, curve.points);
  const double link = curve.length / bodies;
  return chain_of({.radius = radius}, link, links_along(curve.points, link));
}

// F = k' ∫ (2 r - sqrt((2 r - d)² + s²)) ds, which is k' 4/3 d sqrt(2 (2 r - d) d) for small d.
TEST_P(AtMeshes, TubesThatCrossPressAsTheirLensDoes) {
  for (const double overlap : {0.1, 0.2, 0.4}) {
    double force = 0, lens = 0;
    constexpr int places = 10;
    for (int k = 0; k < places; ++k) {  // points lie elsewhere in each
      const RodChain chain = crossing(overlap, 11 + 0.3 * k / places, GetParam());
      const Observation seen = observed(chain, flesh_scene(animal, 5));
      ASSERT_EQ(seen.contact.contacts.size(), 1U);
      const double d = -seen.contact.contacts[0].gap, apart = 2 * radius - d;
      EXPECT_NEAR(d, overlap, 0.01);
      const double half = std::sqrt(4 * radius * d - d * d);
      lens += stiffness * (2 * radius * half - apart * apart * std::asinh(half / apart));
      for (const FleshPoint& point : seen.flesh.points) {
        force += stiffness * point.weight * std::max(0.0, -point.contact.gap);
      }
      // The chord of two circles that overlap by d is 2 sqrt(r d) wide, but for d / r of it.
      const Eigen::Matrix2Xd along = flesh_along(chain.model, animal, seen.kin, seen.flesh);
      const double pressure = stiffness * d / (2 * std::sqrt(radius * d));
      EXPECT_NEAR(along.row(0).maxCoeff(), d, 0.04 * d);
      EXPECT_NEAR(along.row(1).maxCoeff(), pressure, 0.02 * pressure);
      const double link = chain.model.bodies[0].length;
      const double pressed = link * static_cast<double>((along.row(0).array() > 0).count()) / 2;
      EXPECT_NEAR(pressed, 2 * half, 2 * std::max(link, 0.212));
    }
    EXPECT_NEAR(force, lens, force_tolerance * lens) << overlap;
  }
}

/// The animal with the same girth everywhere, straight through a slit of two poles.
struct Slit {
  explicit Slit(int bodies, double share, double step = 0.002, double at = 21.2) {
    scene = table1_scene(bodies);
    scene.wall.present = false;
    scene.clamp_head = false;
    scene.flesh = animal;
    scene.time.step = step;
    scene.script = {};
    Specimen specimen = table1_specimen();
    for (double& around : specimen.circumference) around = 2 * std::numbers::pi * radius;
    model = make_hagfish(specimen, scene);
    half = share * radius;
    for (const double side : {-1.0, 1.0}) {
      const double y = side * (half + pole);
      model.obstacles.push_back({"pole", Strand{{{at, y, -9}, {at, y, 9}}, pole}});
    }
  }
  /// k' ∫ (r + R - sqrt((w/2 + R)² + x²)) dx.
  double force() const {
    const double most = std::sqrt(std::pow(radius + pole, 2) - std::pow(half + pole, 2));
    constexpr int parts = 100000;
    double sum = 0;
    for (int i = 0; i < parts; ++i) {
      const double x = most * (i + 0.5) / parts;
      sum += radius + pole - std::hypot(half + pole, x);
    }
    return 2 * stiffness * sum * most / parts;
  }
  static constexpr double pole = 0.3;  // cm
  double half = 0;                     // of the slit's width, cm
  Scene scene;
  Model model;
};

// Points lie a quarter of a contact apart where it is shortest. So one place may be 3 % off, and
// the mean as the body comes by is not.
TEST_P(AtMeshes, ASlitPressesAsItsShapeSays) {
  for (const double share : {0.9, 0.7, 0.5}) {
    constexpr int places = 20;
    double force = 0;
    for (int k = 0; k < places; ++k) {
      const Slit slit(GetParam(), share, 0.002, 21.2 + 0.424 * k / places);
      const Observation seen = observe(slit.model, rest_state(slit.model), slit.scene);
      double here = 0;
      for (const FleshPoint& point : seen.flesh.points) {
        if (point.contact.obstacle == 0) {
          here += stiffness * point.weight * std::max(0.0, -point.contact.gap);
        }
      }
      EXPECT_NEAR(here, slit.force(), 0.03 * slit.force()) << share;
      force += here / places;
    }
    const double expected = Slit(GetParam(), share).force();
    EXPECT_NEAR(force, expected, force_tolerance * expected) << share;
  }
}

// The pull that it takes does not depend on the step.
TEST(FleshInASlit, IsPulledAlikeAtAnyStep) {
  std::vector<double> pulls;
  for (const double step : {0.005, 0.002, 0.001}) {
    Slit slit(100, 0.7, step);
    slit.scene.controller.law = own_law;
    slit.scene.start.phase = Phase::free;
    SceneRun run(ResolvedScene{slit.scene, {}, slit.model});
    // A stiff damper moves the tail at 3 cm/s.
    run.sim.law = [](const Situation&, Eigen::VectorXd&, Control& control) {
      control.clamp_head = false;
      control.tip = {Eigen::Vector3d(3e5, 0, 0), 1e5};
    };
    double pull = 0;
    int count = 0;
    while (run.time() < 2) {
      const StepRecord& record = run.step();
      if (record.time < 1) continue;
      pull += record.solution.tip.x();
      ++count;
    }
    pulls.push_back(pull / count);
  }
  std::cout << "[ FIGURE   ] " << pulls[0] << ", " << pulls[1] << ", " << pulls[2] << " dyn\n";
  EXPECT_NEAR(pulls[0], pulls[2], 0.02 * pulls[2]);
  EXPECT_NEAR(pulls[1], pulls[2], 0.02 * pulls[2]);
}

// A rope that lies half round a post presses with its tension over its radius, everywhere alike.
TEST(FleshRoundAPost, HasTheOverlapOfItsTension) {
  constexpr double tension = 200;
  ChainRun run = chain_round_a_post();
  run.scene.flesh = {2000, 0.015, 0.2};
  for (int k = 0; k < 20000; ++k) {
    run.step({Eigen::Vector3d(-tension, 0, 0), 0});
    if (k > 100 && run.last.centre_velocity.cwiseAbs().maxCoeff() < 1e-5) break;
  }
  EXPECT_NEAR(-run.last.force[RowKind::head][0], tension, 0.005 * tension);
  double sum = 0, points = 0;
  for (const FleshPoint& point : run.seen.flesh.points) {
    const Eigen::Vector3d from = point.contact.normal;
    if (from.x() < 0.3) continue;  // the middle of the arc
    sum -= point.contact.gap;
    ++points;
  }
  ASSERT_GT(points, 10);
  const double overlap = sum / points;
  const double expected = tension / ((post_radius - overlap) * run.scene.flesh.stiffness);
  EXPECT_NEAR(overlap, expected, 0.02 * expected);
}

// One body on a soft floor: period and decrement of a spring and a damper side by side.
TEST(FleshOnAFloor, SwingsAsASpringAndADamper) {
  for (const TimeRule rule : {TimeRule::euler, TimeRule::midpoint}) {
    constexpr double mass = 2, length = 1, gravity = 981, k = 4e4, tau = 1e-3;
    Model model;
    append_body(model, {mass, length, 0.5, cylinder_inertia(mass, length, 0.5), 0, 0}, {});
    model.gravity = {0, 0, -gravity};
    model.obstacles = {{"floor", Plane{{0, 0, 0}, {0, 0, 1}, 0}}};
    const double h = rule == TimeRule::euler ? 1e-6 : 2e-4;
    ChainRun run(model, bare_scene(h));
    run.scene.clamp_head = false;
    run.scene.time.rule = rule;
    run.scene.flesh = {k, tau, 0.2};
    const double rest = 0.5 - mass * gravity / (k * length);
    run.state.q[2] = rest + 0.02;  // the overlap at rest is 0.049 cm
    double before = 0.02;
    std::vector<double> crossings, peaks;
    double peak = 0;
    while (crossings.size() < 4) {
      run.step();
      const double off = run.state.q[2] - rest;
      peak = std::max(peak, off);
      if (before > 0 && off <= 0) {
        crossings.push_back(run.time - h * off / (off - before));
        peaks.push_back(peak);
        peak = 0;
      }
      before = off;
    }
    const double omega = std::sqrt(k * length / mass), zeta = 0.5 * tau * omega;
    const double damped = omega * std::sqrt(1 - zeta * zeta);
    const double period = (crossings[3] - crossings[1]) / 2;
    EXPECT_NEAR(period, 2 * std::numbers::pi / damped, 0.002 * period);
    const double decrement = std::log(peaks[1] / peaks[3]) / 2;
    EXPECT_NEAR(decrement, 2 * std::numbers::pi * zeta * omega / damped, 0.01 * decrement);
  }
}

}  // namespace hagfish::flesh_test
