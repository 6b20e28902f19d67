// A scene's mirror image runs as its reflection, y to -y, to the last bit: rounding knows no hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/knot/writhe.hpp"
#include "tests/support/scene_run.hpp"

namespace hagfish::mirror_image_test {

const Eigen::Vector3d flip(1, -1, 1);

/// +1 for what a reflection leaves as it is, -1 for what changes its sign: by velocity, nv. Turns
/// about x and z do, and so does the way along y.
Eigen::VectorXd parity_of(const Model& model) {
  Eigen::VectorXd parity(model.nv());
  parity.head<root_dofs>() << 1, -1, 1, -1, 1, -1;
  for (int k = root_dofs; k < model.nv(); ++k) {
    parity[k] = model.hinges[k - root_dofs].axis == Axis::y ? 1 : -1;
  }
  return parity;
}

Eigen::VectorXd reflected_q(const Model& model, const Eigen::VectorXd& q) {
  Eigen::VectorXd image(q.size());
  image.head<7>() << q[0], -q[1], q[2], q[3], -q[4], q[5], -q[6];
  const Eigen::Index hinges = model.nv() - root_dofs;
  image.tail(hinges) = q.tail(hinges).cwiseProduct(parity_of(model).tail(hinges));
  return image;
}

/// What differs first between the records of one step of a run and of its image, or nothing.
std::string difference(const Model& model, const StepRecord& r, const StepRecord& image) {
  const Eigen::VectorXd parity = parity_of(model);
  const auto reflected = [&](const Eigen::VectorXd& of_velocities) -> Eigen::VectorXd {
    return of_velocities.cwiseProduct(parity);
  };
  const StepSolution &s = r.solution, &t = image.solution;
  const ControllerState &c = r.controller, &d = image.controller;
  const std::optional<KnotSpan> span = knot_span(c), other = knot_span(d);
  std::vector<std::pair<std::string, bool>> same = {
      {"q", reflected_q(model, r.after.state.q) == image.after.state.q},
      {"qdot", reflected(r.after.state.qdot) == image.after.state.qdot},
      {"penetration", r.after.observation.penetration == image.after.observation.penetration},
      {"number of rows", s.rows.size() == t.rows.size() && s.active == t.active},
      {"new velocity", reflected(s.qdot) == t.qdot},
      {"active torque", reflected(s.active_torque) == t.active_torque},
      {"tip force", s.tip.cwiseProduct(flip) == t.tip},
      {"phase", c.phase == d.phase && c.phase_start == d.phase_start},
      {"pull", c.pull.sum == d.pull.sum},
      {"knot", c.knot.type == d.knot.type && c.knot.agreement == d.knot.agreement},
      {"ends of the knot",
       span.has_value() == other.has_value() &&
           (!span || (span->head_end == other->head_end && span->tail_end == other->tail_end))},
      {"warnings", r.warnings.size() == image.warnings.size()}};
  for (const RowKind kind : row_kinds) {
    same.emplace_back("force", reflected(s.force[kind]) == t.force[kind]);
    same.emplace_back("work", r.ledger.work[kind] == image.ledger.work[kind]);
  }
  for (auto part : {&EnergyLedger::kinetic, &EnergyLedger::elastic, &EnergyLedger::gravity,
                    &EnergyLedger::work_tip, &EnergyLedger::work_active, &EnergyLedger::dissipated,
                    &EnergyLedger::integrator_held}) {
    same.emplace_back("energy", r.ledger.*part == image.ledger.*part);
  }
  const auto first = std::ranges::find(same, false, &std::pair<std::string, bool>::second);
  return first == same.end() ? "" : first->first;
}

/// Runs a built-in scene with the settings `set`, and its image, side by side until `end` (s) or
/// the end of the scene, and expects the same of every step. Returns the last controller.
ControllerState expect_reflection(const char* name, std::vector<std::string> set, double end) {
  set.insert(set.end(), {"time.step=0.005", "time.frame_interval=0.02"});
  SceneRun plain(name, set);
  set.emplace_back("mirror=true");
  SceneRun turned(name, set);
  double most_writhe = 0;
  while (!plain.over() && plain.time() < end) {
    const StepRecord &record = plain.step(), &image = turned.step();
    const std::string off = difference(plain.model, record, image);
    double w = 0, w_of_image = 0;
    if (record.step % 100 == 0) {
      w = writhe(record.after.observation.kin.centre);
      w_of_image = writhe(image.after.observation.kin.centre);
      most_writhe = std::max(most_writhe, std::abs(w));
    }
    if (!off.empty() || w != -w_of_image) {
      ADD_FAILURE() << "at " << record.time << " s: " << (off.empty() ? "writhe" : off);
      return plain.sim.controller;
    }
  }
  EXPECT_EQ(plain.over(), turned.over());
  EXPECT_GT(most_writhe, 0.1);  // the run has a hand
  return plain.sim.controller;
}

class MirrorImage : public testing::TestWithParam<const char*> {};

TEST_P(MirrorImage, IsTheReflectionOfTheRunToTheLastBit) {
  EXPECT_EQ(expect_reflection(GetParam(), {}, INFINITY).phase, Phase::free);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, MirrorImage,
                         testing::Values("table1", "figure_eight", "double_overhand", "three_twist",
                                         "overhand_waypoints", "overhand_reverse",
                                         "thigmotaxis_everywhere", "double_overhand_paced",
                                         "pull_figure_eight", "living_three_twist",
                                         "reflex_figure_eight", "reflex_reverse"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(MirrorImageOf, SensesThatAreLateAndWrong) {
  expect_reflection("reflex_overhand",
                    {"controller.reflex.delay=0.1", "controller.reflex.noise=0.1"}, 15);
}

TEST(MirrorImageOf, NoiseAndGravityToo) {
  for (const char* name : {"table1", "double_overhand", "living_overhand"}) {
    expect_reflection(name, {"script.noise=0.2", "gravity=[3, 20, -5]"}, 7);
  }
}

}  // namespace hagfish::mirror_image_test
