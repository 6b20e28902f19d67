// A frictionless capstan and the pulley that thigmotaxis makes of it, by hand: a chain without
// stiffness lies half round a post, an obstacle, and comes back beside itself. A pull F at the
// loose end is the pull at the head: no friction takes any of it. The post presses with F over its
// radius on each length of chain, pi F in all. Forces of Eq. 6 between the two strands, which run
// in opposite directions, count twice: of each, one half pulls the head's strand and the other one
// the strand that comes back, which the post hands on. That is sum λ (1 - cos θ) / h of
// experiments/results/leverage/page.md, with θ = 180 degrees.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/chain_runs.hpp"

namespace hagfish::capstan_test {

constexpr double still = 1e-6;  // cm/s, of all bodies that carry a force

class Capstan : public testing::Test {
 protected:
  Capstan() { run.scene.controller.eq6_at = Eq6Point::centreline; }

  /// A step with a pull of `tip` (dyn) along -X at the loose end, and rows of Eq. 6 that ask for
  /// more than their `cap` (dyn) gives between the two strands.
  void step(double tip, double cap) {
    Control control;
    control.tip.value.x() = -tip;
    run.scene.controller.cap = std::max(cap, 1e-9);
    if (cap > 0) control.thigmotaxis.push_back({strands(), {1e3, 1e3}});
    run.step(control);
  }

  /// The pair of points beside each other, as far from the post, on the strand of the head and on
  /// the one that comes back.
  Contact strands() const {
    const Observation seen = observe(run.model, run.state, run.scene);
    const int bodies = run.model.body_count();
    int back = bodies / 2;  // on the post
    const Eigen::Matrix3Xd& centre = seen.kin.centre;
    constexpr int beside = 12;  // body at which the strands push each other
    for (int b = back; b < bodies - 2; ++b) {
      back = (centre.col(b) - centre.col(beside)).norm() <
                     (centre.col(back) - centre.col(beside)).norm()
                 ? b
                 : back;
    }
    last_loaded = back + 2;
    return contact_at(seen.segments, beside, 0, back, 0);
  }

  /// Steps until all bodies up to `last_loaded` are at rest.
  void settle(double tip, double cap) {
    for (int k = 0; k < 20000; ++k) {
      step(tip, cap);
      if (k > 100 && run.last.centre_velocity.leftCols(last_loaded).cwiseAbs().maxCoeff() < still) {
        return;
      }
    }
    FAIL() << "does not come to rest";
  }

  /// Force on the post, dyn.
  Eigen::Vector3d on_post() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < run.last.rows.size(); ++i) {
      if (run.last.rows[i].kind == RowKind::obstacle) {
        sum -= run.last.lambda[static_cast<Eigen::Index>(i)] / run.scene.time.step *
               run.last.rows[i].points().direction;
      }
    }
    return sum;
  }
  /// Sum of the forces of the post, dyn, whatever their ways.
  double pressed() const {
    double sum = 0;
    for (std::size_t i = 0; i < run.last.rows.size(); ++i) {
      if (run.last.rows[i].kind == RowKind::obstacle) {
        sum += run.last.lambda[static_cast<Eigen::Index>(i)] / run.scene.time.step;
      }
    }
    return sum;
  }
  double pull() const { return -run.last.force[RowKind::head][0]; }

  ChainRun run = chain_round_a_post();
  mutable int last_loaded = run.model.body_count();
};

/// Of the tension: a link that touches the post beside its middle is not tangent to it there.
constexpr double tolerance = post_link * post_link / (8 * post_radius * post_radius);

TEST_F(Capstan, HandsOnAllOfThePull) {
  for (const double tension : {50.0, 200.0}) {
    settle(tension, 0);
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_NEAR(pull(), tension, tolerance * tension);
    EXPECT_NEAR(on_post().x(), -2 * tension, tolerance * tension);
    EXPECT_NEAR(pressed(), std::numbers::pi * tension, tolerance * std::numbers::pi * tension);
  }
}

TEST_F(Capstan, IsAPulleyForThigmotaxis) {
  settle(50, 0);
  for (const double cap : {50.0, 100.0}) {  // of each of two rows
    settle(0, cap);
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_NEAR(pull(), 2 * (2 * cap), tolerance * 4 * cap);
    EXPECT_NEAR(on_post().x(), -4 * cap, tolerance * 4 * cap);
  }
}

}  // namespace hagfish::capstan_test
