#include "experiments/mechanics/mechanics.hpp"

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "core/chain/articulated.hpp"
#include "core/chain/dynamics.hpp"
#include "core/input/builtin_files.hpp"
#include "core/input/scene_text.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {
namespace {

void print_numbers(const char* name, const double* values, Eigen::Index count, const char* end) {
  std::printf("\"%s\":[", name);
  for (Eigen::Index i = 0; i < count; ++i) std::printf("%s%.17g", i > 0 ? "," : "", values[i]);
  std::printf("]%s", end);
}

void print_state(const Model& model, const State& state) {
  const Kinematics kin = kinematics(model, state);
  const StepOperator op{body_inertias(model, kin), Eigen::VectorXd::Zero(model.nv())};
  const Eigen::MatrixXd mass = dense(model, kin, op);
  const Matrix6Xd wrench = bias_wrench(model, kin, motion_of(kin)) - gravity_wrench(model, kin);
  const Eigen::VectorXd bias = generalised_force(model, kin, wrench);
  const Eigen::Matrix3Xd place = kin.origin;
  std::printf("{");
  print_numbers("q", state.q.data(), state.q.size(), ",");
  print_numbers("qdot", state.qdot.data(), state.qdot.size(), ",");
  print_numbers("place", place.data(), place.size(), ",");
  print_numbers("mass", mass.data(), mass.size(), ",");
  print_numbers("bias", bias.data(), bias.size(), "}");
}

}  // namespace

void print_mirrored_states() {
  const std::string text(builtin_file("table1.toml").value());
  const ResolvedScene resolved = read_scene_source({text, "table1", std::nullopt}, {}, {});
  const Model& model = resolved.model;
  Simulation sim = start(model, resolved.scene, "active-set");
  std::printf("{\"length\":%.17g,\"states\":[", model.length());
  constexpr int states = 10;
  constexpr double apart = 1.6;  // s: the knot is tied at 11 s, and slides until 18 s
  const auto steps = std::lround(apart / resolved.scene.time.step);
  for (int i = 0; i < states; ++i) {
    for (long k = 0; k < steps; ++k) take_step(model, resolved.scene, sim);
    if (i > 0) std::printf(",");
    print_state(model, sim.now.state);
  }
  std::puts("]}");
}

}  // namespace hagfish
