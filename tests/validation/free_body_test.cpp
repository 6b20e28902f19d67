// A body that nothing holds, in empty space: nothing but its shape changes, and it turns only as
// that makes it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <numbers>

#include "tests/support/stored_states.hpp"

namespace hagfish::free_body_test {

constexpr int bodies = 20;
constexpr double pi = std::numbers::pi;

/// The hagfish in empty space: no water, plate, clamp or gravity.
ResolvedScene empty_space(const std::string& rule, double h,
                          const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{"clamp_head=false",
                               "wall.present=false",
                               "drag.normal=0",
                               "drag.tangential=0",
                               "script.kind=none",
                               "expect.knot=\"\"",
                               "model.bodies=" + std::to_string(bodies),
                               "active.stiffness=2e5",
                               "active.capacity=1e9",
                               "controller.law=own",
                               "time.frame_interval=0.1",
                               "time.settled=1e-6",
                               "time.rule=" + rule,
                               "time.step=" + std::to_string(h)};
  set.insert(set.end(), more.begin(), more.end());
  return scene_argument("table1", set);
}

/// A wave of bending that travels from head to tail, 2 rad of it, each second; about Z and,
/// `turned` a quarter of a wave behind, about Y.
ControlLaw wave(double turned) {
  return [turned](const Situation& at, Eigen::VectorXd&, Control& control) {
    const double rise = std::min(1.0, at.time / 0.5);
    const double size = 0.5 * (1 - std::cos(pi * rise)) * 4.0 / bodies;
    control.rest_shape.setZero(at.model.nv());
    for (int k = root_dofs; k < at.model.nv(); ++k) {
      const Hinge& hinge = at.model.hinges[k - root_dofs];
      const double phase = 2 * pi * (static_cast<double>(hinge.body) / bodies - at.time);
      if (hinge.axis == Axis::z) control.rest_shape[k] = size * std::sin(phase);
      if (hinge.axis == Axis::y) control.rest_shape[k] = turned * size * std::cos(phase);
    }
  };
}

struct FreeRun : SceneRun {
  FreeRun(const ResolvedScene& of, ControlLaw law) : SceneRun(of) {
    sim.law = std::move(law);
    centre = centre_of_mass(model, sim.now.observation.kin);
  }
  void step() {
    before = sim.now.observation.kin;
    SceneRun::step();
    const Kinematics& kin = sim.now.observation.kin;
    moved = std::max(moved, (centre_of_mass(model, kin) - centre).norm());
    std::ranges::copy_if(record.warnings, std::back_inserter(told), [](const std::string& warning) {
      return warning.find("pushed the free body") != std::string::npos;
    });
  }
  /// Of the head about Z, rad, of a body that moves in the plane.
  double angle() const { return 2 * std::atan2(sim.now.state.q[6], sim.now.state.q[3]); }

  Kinematics before;  // the last step
  Eigen::Vector3d centre;
  double moved = 0;
  std::vector<std::string> told;  // of momentum
};

class FreeBody : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Rules, FreeBody, testing::Values("euler", "midpoint"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(FreeBody, MovesItsCentreOfMassAtNoStep) {
  for (const double h : {0.01, 0.005, 0.002, 0.001}) {
    FreeRun run(empty_space(GetParam(), h), wave(0.7));
    double linear = 0, angular = 0;
    while (run.time() < 2) {
      run.step();
      linear = std::max(linear, run.sim.momentum.momentum.linear.norm());
      angular = std::max(angular, run.sim.momentum.momentum.angular.norm());
    }
    std::cout << "[ FIGURE   ] " << GetParam() << ", h = " << 1e3 * h << " ms: centre of mass "
              << run.moved << " cm, momentum " << linear << " g cm/s, " << angular << " g cm²/s\n";
    EXPECT_LT(run.moved, 1e-9);
    EXPECT_TRUE(run.told.empty());
    // Rounding of some 1e3 g cm/s and 1e4 g cm²/s of the parts.
    EXPECT_LT(linear, 1e-9);
    EXPECT_LT(angular, 1e-8);
    EXPECT_GT(
        run.sim.momentum.given_back.linear.norm() + run.sim.momentum.given_back.angular.norm(),
        GetParam() == std::string("euler") ? 1 : 1e-3);  // it had to be made so
  }
}

/// The turn of a planar body without angular momentum by its change of shape alone: dθ = -A dα,
/// with the moment about Z of unit hinge rates over that of the whole (the mechanical connection).
/// By the trapezoidal rule between two moments.
double holonomy(const FreeRun& run) {
  const auto rate = [&](const Kinematics& kin, const Eigen::VectorXd& change) {
    const Matrix6Xd twist = body_twists(run.model, kin, change);
    const Eigen::Vector3d centre = centre_of_mass(run.model, kin);
    double angular = 0, inertia = 0;
    for (int b = 0; b < bodies; ++b) {
      const Body& body = run.model.bodies[b];
      const Eigen::Vector3d from = kin.centre.col(b) - centre;
      const Eigen::Vector3d velocity = point_velocity(twist.col(b), kin.centre_offset(b));
      angular += body.mass * from.cross(velocity).z() + body.inertia.z() * twist(2, b);
      inertia += body.mass * from.head<2>().squaredNorm() + body.inertia.z();
    }
    return -angular / inertia;
  };
  const StepRecord& record = run.record;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(run.model.nv());
  change.tail(run.model.nv() - root_dofs) =
      (run.sim.now.state.q - record.after.state.q).tail(run.model.nv() - root_dofs);
  return 0.5 * (rate(run.before, change) + rate(run.sim.now.observation.kin, change));
}

/// How far the head's angle is from what shapes make of it, at most in 2 s, rad.
double angle_off(const std::string& rule, double h) {
  FreeRun run(empty_space(rule, h), wave(0));
  double wanted = 0, off = 0;
  while (run.time() < 2) {
    run.step();
    wanted += holonomy(run);
    off = std::max(off, std::abs(std::remainder(run.angle() - wanted, 2 * pi)));
  }
  return off;
}

// A falling cat turns without momentum: how far follows from the shapes that it goes through. What
// steps leave of that is of the rule's order.
TEST(FreeBodyRule, TurnsAsItsShapesMakeIt) {
  const double euler[] = {angle_off("euler", 0.0025), angle_off("euler", 0.00125)};
  const double midpoint[] = {angle_off("midpoint", 0.005), angle_off("midpoint", 0.0025)};
  std::cout << "[ FIGURE   ] angle off, Euler at 2.5 and 1.25 ms " << euler[0] << ", " << euler[1]
            << "; midpoint at 5 and 2.5 ms " << midpoint[0] << ", " << midpoint[1] << " rad\n";
  EXPECT_LT(euler[1], euler[0] / 1.7);      // 2 in the limit
  EXPECT_LT(midpoint[1], midpoint[0] / 3);  // 4 in the limit
  EXPECT_LT(midpoint[0], 1e-2);
}

/// Who looks at the body: one who moves against it, falls or has turned.
struct Observer {
  const char* name;
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();    ///< of the body for that one, cm/s
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< cm/s²
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
};

/// A body let go in empty space, `tied` as the paper's run is as it begins to tighten, else bent:
/// its angles in 0.5 s, rad, a column for each step.
Eigen::MatrixXd let_go(const std::string& rule, bool tied, const Observer& observer) {
  const Eigen::Vector3d& g = observer.gravity;
  SceneRun run(
      stored_scene({"clamp_head=false", "wall.present=false", "drag.normal=0", "drag.tangential=0",
                    "script.kind=none", "expect.knot=", "expect.types=[]", "time.step=0.005",
                    "time.rule=" + rule, fmt::format("gravity=[{},{},{}]", g[0], g[1], g[2])}));
  const Model& model = run.model;
  State state = rest_state(model);
  for (const Body& body : model.bodies) {
    if (bends(body)) state.q.segment<2>(body.first_dof + 1).setConstant(0.02);
  }
  if (tied) state.q = stored_state("tighten").state.q;
  const Eigen::Quaterniond turned = observer.turn * root_orientation(state.q);
  state.q.head<3>() = observer.turn * state.q.head<3>();
  state.q.segment<4>(3) << turned.w(), turned.x(), turned.y(), turned.z();
  state.qdot.head<3>() = observer.drift;
  ControllerState controller;
  controller.phase = Phase::free;
  run.sim = start_from(model, run.scene, "active-set", state, controller, 0);
  Eigen::MatrixXd angles(model.nv() - root_dofs, 100);
  for (Eigen::Index k = 0; k < angles.cols(); ++k) {
    const std::vector<std::string>& warnings = run.step().warnings;
    EXPECT_TRUE(warnings.empty()) << warnings.front();
    angles.col(k) = run.sim.now.state.q.tail(angles.rows());
  }
  return angles;
}

// Nothing outside acts, so that the shape knows no frame of reference: rounding alone differs,
// which the contacts of a knot that springs open amplify some thousand times.
TEST_P(FreeBody, HasOneShapeForEachObserver) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();  // {} would leave it unset
  for (const bool tied : {false, true}) {
    const Eigen::MatrixXd rest = let_go(GetParam(), tied, {"at rest"});
    EXPECT_GT((rest.rightCols<1>() - rest.leftCols<1>()).lpNorm<Eigen::Infinity>(), 0.01);
    for (const Observer& observer :
         {Observer{"slow", {12, -16, 0}}, Observer{"fast", {48, 0, 64}},
          Observer{"falling", none, {0, 0, -981}},
          Observer{"falling aside", {80, 0, 0}, {300, 0, -900}},
          Observer{"turned", none, none, Eigen::Quaterniond(0.5, -0.5, 0.1, 0.7).normalized()}}) {
      const double off = (let_go(GetParam(), tied, observer) - rest).cwiseAbs().maxCoeff();
      std::cout << "[ FIGURE   ] " << GetParam() << (tied ? ", knot, " : ", bent, ")
                << observer.name << ": shape off by " << off << " rad in 0.5 s\n";
      EXPECT_LT(off, tied ? 1e-7 : 1e-9) << observer.name;
    }
  }
}

}  // namespace hagfish::free_body_test
