// What it costs to keep a pulled knot's strands apart: overlap against CPU time, in both
// simulators.
//   hagfish_overlap SCENE LOG...
// SCENE pulls a knot by the tail (stability/pulled_knot.toml); each LOG gives an animal's number of
// bodies and its knotted state (start.hpp). Prints CSV, a row for each setting.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/chain/dynamics.hpp"
#include "core/chain/start.hpp"
#include "core/contact/observation.hpp"
#include "core/run/drive.hpp"
#include "experiments/benchmarks/mujoco_setting.hpp"
#include "experiments/benchmarks/start.hpp"
#include "experiments/common/cpu_time.hpp"
#include "mujoco_ref/mirror.hpp"

namespace {

using namespace hagfish;

constexpr double pull = 1000;                                                // dyn
constexpr std::array core_steps = {0.005, 0.002, 0.001};                     // s
constexpr std::array mujoco_steps = {0.005, 0.002, 0.001, 0.0005, 0.00025};  // s
// Time constants of MuJoCo's contacts and limits (solref) in steps, of which they must be two at
// least, and the share of a violation's acceleration that they take (solimp). First its defaults.
constexpr double default_constant = 0.02;  // s
constexpr double default_share = 0.9;
constexpr std::array constants = {2.0, 3.0, 4.0};
constexpr std::array shares = {default_share, 0.99};
constexpr int repeats = 2;

/// What a run showed: the deepest overlap and the furthest that a joint was past a limit in its
/// second half, when the knot has settled, and the CPU time of a simulated second (of
/// mj_step alone: the water's drag comes from the core).
struct Seen {
  double overlap = 0;  ///< cm, of what the simulator holds apart: skins, or capsules
  double limits = 0;   ///< rad
  double cpu = std::numeric_limits<double>::infinity();  ///< s
};

/// The scene with the animal and the state of `knotted`, at rest.
ResolvedScene pulled(const std::string& scene, const Start& knotted) {
  const Eigen::VectorXd& q = knotted.middle().now.state.q;
  std::string text;
  for (const double value : q) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
  }
  return read_scene(
      scene, {fmt::format("model.bodies={}", knotted.model.body_count()),
              fmt::format("start.q=[{}]", text),
              fmt::format("script.knots=[[0.0, {0}, 0.0, 0.0], [1.0, {0}, 0.0, 0.0]]", pull)});
}

Seen run_core(const ResolvedScene& resolved, double h) {
  Scene scene = resolved.scene;
  scene.time.step = h;
  const Model& model = resolved.model;
  Simulation sim = start(model, scene, "active-set");
  StepRecord record;
  Seen seen;
  const double begin = cpu_time();
  const auto look = [&](const StepRecord&, const Simulation& at) {
    if (time_of(at, scene) <= 0.5 * scene.time.duration) return;
    seen.overlap = std::max(seen.overlap, at.now.observation.penetration);
    seen.limits = std::max(seen.limits, at.now.observation.limit_violation);
  };
  if (const Status end = drive(model, scene, sim, record, {look}); !end.ok()) throw StepError(end);
  seen.cpu = (cpu_time() - begin) / scene.time.duration;
  return seen;
}

Seen run_mujoco(const ResolvedScene& resolved, double h, double constant, double share) {
  const Scene& scene = resolved.scene;
  const Model& model = resolved.model;
  MujocoModel mirror(mjcf_files(model, scene.contact.least_arc, h, Head::clamped));
  mjModel& mujoco = *mirror.model();
  mjData& data = *mirror.data();
  MujocoSetting{"newton", "dense", 1e-8}.apply(mujoco);
  set_stiffness(constant, share, mujoco);
  set_state(model, start_state(model, scene.start), mirror);
  const int last =
      mj_name2id(&mujoco, mjOBJ_BODY, fmt::format("b{}", model.body_count() - 1).c_str());
  data.xfrc_applied[6 * last] = pull;
  const auto steps = std::lround(scene.time.duration / h);
  Seen seen{.cpu = 0};
  ContactSearch search;
  Observation at;
  observe(model, state_of(model, mirror), scene, search, at);
  for (long k = 1; k <= steps; ++k) {
    const Eigen::VectorXd drag = drag_force(model, at.kin, state_of(model, mirror).qdot);
    mju_copy(data.qfrc_applied, drag.tail(mujoco.nv).data(), mujoco.nv);
    const double begin = cpu_time();
    mj_step(&mujoco, &data);
    seen.cpu += (cpu_time() - begin) / scene.time.duration;
    observe(model, state_of(model, mirror), scene, search, at);
    if (2 * k > steps) {
      for (int c = 0; c < data.ncon; ++c) {
        seen.overlap = std::max<double>(seen.overlap, -data.contact[c].dist);
      }
      seen.limits = std::max(seen.limits, at.limit_violation);
    }
  }
  check_stable(mirror);
  return seen;
}

template <class Run>
void print_row(int bodies, const std::string& simulator, double h, double constant, double share,
               Run run) {
  Seen seen = run();
  for (int k = 1; k < repeats; ++k) {
    seen.cpu = std::min(seen.cpu, run().cpu);
  }
  fmt::print("{},{},{:g},{:g},{:g},{:.3g},{:.3g},{:.4g}\n", bodies, simulator, 1e3 * h,
             1e3 * constant, share, seen.overlap, seen.limits * 180 / std::numbers::pi, seen.cpu);
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("bodies,simulator,h_ms,constant_ms,share,overlap_cm,limits_deg,cpu_s\n");
  try {
    for (int k = 2; k < argc; ++k) {
      const Start knotted = knotted_start(argv[k]);
      const ResolvedScene scene = pulled(argv[1], knotted);
      const int bodies = knotted.model.body_count();
      for (const double h : core_steps) {
        print_row(bodies, "core", h, 0, 1, [&] { return run_core(scene, h); });
      }
      for (const double h : mujoco_steps) {
        print_row(bodies, "mujoco", h, default_constant, default_share,
                  [&] { return run_mujoco(scene, h, default_constant, default_share); });
        for (const double constant : constants) {
          for (const double share : shares) {
            print_row(bodies, "mujoco", h, constant * h, share,
                      [&] { return run_mujoco(scene, h, constant * h, share); });
          }
        }
      }
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "hagfish_overlap: {}\n", error.what());
    return 2;
  }
  return 0;
}
