// A scene's mirror image runs as its reflection, y to -y, to the last bit: rounding knows no hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "core/knot/writhe.hpp"
#include "core/run/simulation.hpp"

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

/// Compares the records of one step of a run and of its image; keeps what differs first.
class Comparison {
 public:
  explicit Comparison(const Model& model) : model_(model), parity_(parity_of(model)) {}

  void compare(const StepRecord& r, const StepRecord& image) {
    motion(r, image);
    solution(r.solution, image.solution);
    for (auto list : {&ContactSet::contacts, &ContactSet::near_pairs}) {
      contacts(r.after.observation.contact.*list, image.after.observation.contact.*list);
    }
    controller(r.controller, image.controller);
    ledger(r.ledger, image.ledger);
    same("warnings", r.warnings.size(), image.warnings.size());
  }
  const std::string& first() const { return first_; }

 private:
  template <class T>
  void same(const std::string& what, const T& value, const T& image) {
    if (first_.empty() && !(value == image)) first_ = what;
  }

  void motion(const StepRecord& r, const StepRecord& image) {
    same("time", r.time, image.time);
    same("q", reflected_q(model_, r.after.state.q), image.after.state.q);
    same("qdot", r.after.state.qdot.cwiseProduct(parity_).eval(), image.after.state.qdot);
    same("positions", (flip.asDiagonal() * r.after.observation.kin.centre).eval(),
         image.after.observation.kin.centre);
    same("penetration", r.after.observation.penetration, image.after.observation.penetration);
    same("limit violation", r.after.observation.limit_violation,
         image.after.observation.limit_violation);
    same("head drift", r.head_drift, image.head_drift);
    same("crossing", r.crossing, image.crossing);
  }

  void solution(const StepSolution& s, const StepSolution& image) {
    same("kind", s.kind, image.kind);
    same("active", s.active, image.active);
    same("iterations", s.iterations, image.iterations);
    same("rounds", s.rounds, image.rounds);
    same("new velocity", s.qdot.cwiseProduct(parity_).eval(), image.qdot);
    for (const RowKind kind : row_kinds) {
      same("force", s.force[kind].cwiseProduct(parity_).eval(), image.force[kind]);
    }
    same("active torque", s.active_torque.cwiseProduct(parity_).eval(), image.active_torque);
    same("tip force", s.tip.cwiseProduct(flip).eval(), image.tip);
    same("stationarity", s.stationarity, image.stationarity);
    same("kkt", s.kkt.worst(), image.kkt.worst());
    same("rows", s.rows.size(), image.rows.size());
    for (std::size_t i = 0; i < std::min(s.rows.size(), image.rows.size()); ++i) {
      const Row& row = s.rows[i];
      const std::string name = row_name(model_, row);
      const double sign = row.kind == RowKind::head ? parity_[row.joint()->dof] : 1;
      same("kind of " + name, row.kind, image.rows[i].kind);
      same("lambda of " + name, sign * s.lambda[i], image.lambda[i]);
      same("excess of " + name, sign * s.excess[i], image.excess[i]);
    }
  }

  void contacts(const std::vector<Contact>& list, const std::vector<Contact>& image) {
    same("contacts", list.size(), image.size());
    for (std::size_t i = 0; i < std::min(list.size(), image.size()); ++i) {
      contact(list[i], image[i]);
    }
  }
  void contact(const Contact& c, const Contact& image) {
    same("arc of contact", std::pair(c.arc_a, c.arc_b), std::pair(image.arc_a, image.arc_b));
    same("gap of contact", c.gap, image.gap);
    same("normal of contact", c.normal.cwiseProduct(flip).eval(), image.normal);
    same("tangent of contact", c.tangent_a.cwiseProduct(flip).eval(), image.tangent_a);
  }

  void controller(const ControllerState& c, const ControllerState& image) {
    same("phase", c.phase, image.phase);
    same("phase start", c.phase_start, image.phase_start);
    same("pull", c.pull.sum, image.pull.sum);
    same("knot", c.knot.type, image.knot.type);
    same("agreement", c.knot.agreement, image.knot.agreement);
    same("knot from", c.knot_from, image.knot_from);
    for (auto end : {&TouchingEnds::first, &TouchingEnds::last}) {
      const std::optional<Contact>&ours = c.ends.*end, &theirs = image.ends.*end;
      same("end of the contact", ours.has_value(), theirs.has_value());
      if (ours && theirs) {
        contact(*ours, *theirs);
      }
    }
  }

  void ledger(const EnergyLedger& l, const EnergyLedger& image) {
    for (auto part :
         {&EnergyLedger::kinetic, &EnergyLedger::elastic, &EnergyLedger::gravity,
          &EnergyLedger::work_tip, &EnergyLedger::work_active, &EnergyLedger::dissipated,
          &EnergyLedger::integrator_inertia, &EnergyLedger::integrator_potential,
          &EnergyLedger::integrator_coriolis, &EnergyLedger::integrator_held}) {
      same("energy", l.*part, image.*part);
    }
    same("work", l.work.of_kind, image.work.of_kind);
  }

  const Model& model_;
  Eigen::VectorXd parity_;
  std::string first_;
};

/// Runs a built-in scene with the settings `set`, and its image, side by side until `end` (s) or
/// the end of the scene, and expects the same of every step. Returns the last controller.
ControllerState expect_reflection(const char* name, std::vector<std::string> set, double end) {
  const std::string file = std::string(HAGFISH_DATA_DIR) + "/" + name + ".toml";
  set.insert(set.end(), {"time.step=0.005", "time.frame_interval=0.02"});
  const ResolvedScene plain = read_scene(file, set);
  set.emplace_back("mirror=true");
  const ResolvedScene turned = read_scene(file, set);
  const Model model = make_hagfish(plain.specimen, plain.scene);
  const Model model_of_image = make_hagfish(turned.specimen, turned.scene);  // gravity differs
  Simulation sim = start(model, plain.scene, "active-set");
  Simulation image = start(model_of_image, turned.scene, "active-set");
  StepRecord record, record_of_image;
  Comparison comparison(model);
  double most_writhe = 0;
  while (!finished(sim, plain.scene) && time_of(sim, plain.scene) < end) {
    take_step(model, plain.scene, sim, record);
    take_step(model_of_image, turned.scene, image, record_of_image);
    comparison.compare(record, record_of_image);
    double w = 0, w_of_image = 0;
    if (record.step % 100 == 0) {
      w = writhe(record.after.observation.kin.centre);
      w_of_image = writhe(record_of_image.after.observation.kin.centre);
      most_writhe = std::max(most_writhe, std::abs(w));
    }
    if (!comparison.first().empty() || w != -w_of_image) {
      ADD_FAILURE() << "at " << record.time
                    << " s: " << (comparison.first().empty() ? "writhe" : comparison.first());
      return sim.controller;
    }
  }
  EXPECT_EQ(finished(sim, plain.scene), finished(image, turned.scene));
  EXPECT_GT(most_writhe, 0.1);  // the run has a hand
  return sim.controller;
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
