// An animal of another size is the same animal: with every number of a scene scaled by its
// dimension, all angles stay as they are. By powers of two nothing is rounded on the way, so that
// a constant of the code that has a dimension shows, as does a scale that a number was forgotten
// in.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/scene_run.hpp"

namespace hagfish::scale_test {

/// Units of length, mass and time over those of the scene as it is.
struct Scale {
  double length = 1, mass = 1, time = 1;

  double speed() const { return length / time; }
  double force() const { return mass * length / (time * time); }
  double torque() const { return force() * length; }
  double rigidity() const { return torque() * length; }
};

void scale(std::vector<double>& values, double by) {
  for (double& value : values) value *= by;
}

void scale(ThigmotaxisSpeeds& speed, double by) {
  speed.a *= by;
  speed.b *= by;
}

void scale(Specimen& s, const Scale& by) {
  s.length *= by.length;
  s.mass *= by.mass;
  s.bending_span *= by.length;
  scale(s.circumference, by.length);
  scale(s.bending_stiffness, by.rigidity());
  scale(s.twist_stiffness, by.rigidity());
  scale(s.bending_damping, by.rigidity() * by.time);
  scale(s.twist_damping, by.rigidity() * by.time);
}

void scale(ControllerSettings& s, const Scale& by) {
  for (ThigmotaxisSpeeds* speed : {&s.tighten_head, &s.tighten_tail, &s.slide_head, &s.slide_tail,
                                   &s.reverse_head, &s.reverse_tail}) {
    scale(*speed, by.speed());
  }
  s.cap *= by.force();
  for (double* length : {&s.contact_gap, &s.contact_patch, &s.tail_through, &s.tight_span,
                         &s.release_at, &s.reflex.shift, &s.reflex.pull_shift, &s.reflex.reach}) {
    *length *= by.length;
  }
  for (double* time : {&s.tighten_from, &s.tight_hold, &s.tighten_time, &s.untied_for, &s.free_time,
                       &s.reflex.delay}) {
    *time *= by.time;
  }
}

void scale(Scene& s, const Scale& by) {
  s.model.bending_stiffness *= by.rigidity();
  s.model.twist_stiffness *= by.rigidity();
  s.model.bending_damping *= by.rigidity() * by.time;
  s.model.twist_damping *= by.rigidity() * by.time;
  s.drag.normal *= by.mass / (by.time * by.length);
  s.drag.tangential *= by.mass / (by.time * by.length);
  s.constraints.baumgarte_speed *= by.speed();
  s.constraints.tolerance *= by.length;
  s.constraints.stride *= by.length;
  s.contact.margin *= by.length;
  s.contact.least_arc *= by.length;
  s.wall.neck *= by.length;
  for (Waypoint& knot : s.script.waypoints) {
    knot.time *= by.time;
    knot.value *= s.script.kind == ScriptSettings::Kind::force ? by.force() : by.length;
  }
  s.script.spring *= by.force() / by.length;
  s.script.damper *= by.force() / by.speed();
  s.script.largest_force *= by.force();
  scale(s.script.curvature.time, by.time);
  s.active.stiffness *= by.rigidity();
  s.active.tone_time *= by.time;
  s.active.relax_time *= by.time;
  s.active.capacity *= by.torque();
  scale(s.controller, by);
  s.knot.interval *= by.time;
  for (double* time :
       {&s.time.step, &s.time.frame_interval, &s.time.duration, &s.guard.capped_time}) {
    *time *= by.time;
  }
  s.guard.penetration *= by.length;
  s.guard.speed *= by.speed();
}

/// Hinge angles where a run ends.
Eigen::VectorXd angles_after(ResolvedScene resolved, const Scale& by) {
  scale(resolved.specimen, by);
  scale(resolved.scene, by);
  SceneRun run(resolved.specimen, resolved.scene);
  while (!run.over()) run.step();
  EXPECT_EQ(run.phase(), Phase::slide);
  return run.sim.now.state.q.tail(run.model.nv() - root_dofs);
}

class Scales : public testing::TestWithParam<const char*> {};

TEST_P(Scales, ChangeNoAngle) {
  // Into the slide, at a coarse step.
  const ResolvedScene resolved =
      scene_argument(GetParam(), {"time.step=0.02", "time.until=slide", "time.duration=15"});
  const Eigen::VectorXd angles = angles_after(resolved, {});
  for (const Scale& by : {Scale{0.125}, {0.5}, {8}, {1, 4}, {1, 1, 2}, {32, 0.25, 0.5}}) {
    const double off = (angles_after(resolved, by) - angles).lpNorm<Eigen::Infinity>();
    EXPECT_LT(off, 1e-9) << by.length << ", " << by.mass << ", " << by.time;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Scales,
                         testing::Values("table1", "living_overhand", "reflex_overhand"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace hagfish::scale_test
