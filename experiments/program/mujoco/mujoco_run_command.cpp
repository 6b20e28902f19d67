#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>

#include "core/log/reading/log_contents.hpp"
#include "core/log/reading/logged_run.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/common/scene_sense.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scene_run.hpp"
#include "mujoco_ref/closed_loop.hpp"

namespace hagfish {
namespace {

struct MujocoRunOptions {
  std::string scene;             ///< a built-in scene's name or a file
  std::string from;              ///< a log, from the start of whose slide it goes on
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  double step = 0.001;           ///< s
  MujocoSettings mujoco;
  RunOptions run;
};

const std::map<std::string, MujocoIntegrator> integrators = {
    {"euler", MujocoIntegrator::euler},
    {"implicit", MujocoIntegrator::implicit},
    {"rk4", MujocoIntegrator::rk4}};

/// A run about to begin.
struct Beginning {
  ResolvedScene resolved;
  Simulation sim;
};

/// What MuJoCo has of its own: the time step and its rule, and no head plate.
std::vector<std::string> changes(const MujocoRunOptions& options) {
  std::vector<std::string> set = {fmt::format("time.step={}", options.step), "time.rule=euler",
                                  "wall.present=false"};
  set.insert(set.end(), options.set.begin(), options.set.end());
  return set;
}

Beginning begin_scene(const MujocoRunOptions& options) {
  ResolvedScene resolved = scene_argument(options.scene, changes(options));
  Simulation sim = start(resolved.model, resolved.scene, "active-set");
  return {std::move(resolved), std::move(sim)};
}

Beginning begin_slide(const MujocoRunOptions& options) {
  const LogContents log(options.from);
  const auto slides = [](std::int64_t phase) { return phase == static_cast<int>(Phase::slide); };
  const auto first = std::ranges::find_if(log.phase, slides) - log.phase.begin();
  if (first == static_cast<std::ptrdiff_t>(log.phase.size())) {
    throw FileError(options.from + ": has no slide of the knot");
  }
  ResolvedScene resolved = logged_scene(log.h5, changes(options));
  if (resolved.model.nv() != log.model.nv()) {
    throw InputError(options.from + ": its animal and the scene differ in model.bodies");
  }
  ControllerState controller;
  controller.phase = Phase::slide;
  controller.phase_start = log.time[static_cast<std::size_t>(first)];
  const auto step = std::llround(controller.phase_start / resolved.scene.time.step);
  Simulation sim = start_from(resolved.model, resolved.scene, "active-set",
                              {log.q.row(first), log.qdot.row(first)}, controller, step);
  return {std::move(resolved), std::move(sim)};
}

int run_in_mujoco(const MujocoRunOptions& options, const std::string& typed) {
  Beginning begun = options.from.empty() ? begin_scene(options) : begin_slide(options);
  const Scene& scene = begun.resolved.scene;
  check_sense(begun.resolved, options.run.force);
  MujocoLoop loop(begun.resolved.model, scene, options.mujoco);
  LogHeader header = log_header(begun.resolved, "active-set", typed);
  header.simulator = fmt::format("MuJoCo {}", mj_versionString());
  LogWriter log(options.run.out, options.run.force, header, begun.resolved.model, scene);
  return take_run(begun.resolved.model, scene, std::move(begun.sim), options.run, log,
                  [&loop](Simulation& sim, StepRecord& record) { loop.take_step(sim, record); });
}

}  // namespace

void add_mujoco_run(Program& program) {
  const auto options = std::make_shared<MujocoRunOptions>();
  CLI::App* app = program.app.add_subcommand(
      "mujoco-run",
      "run a scene in MuJoCo, in closed loop: its law (reflex), MuJoCo's motion, contacts, limits");
  CLI::Option* scene = app->add_option("SCENE", options->scene, scene_help);
  CLI::Option* from = app->add_option(
      "--from", options->from, "go on from the start of the slide in this log, in its own scene");
  from->excludes(scene);
  app->add_option("--out", options->run.out, "log to write")->required();
  app->add_option("--set", options->set, set_help)->allow_extra_args(false);
  app->add_option("--step", options->step, "time step, s")
      ->check(above_zero())
      ->capture_default_str();
  app->add_option("--integrator", options->mujoco.integrator, "MuJoCo's: euler, implicit or rk4")
      ->transform(CLI::CheckedTransformer(integrators))
      ->default_str("euler");
  app->add_option("--contact-time", options->mujoco.contact_time,
                  "time constant of contacts and limits (solref), s; two steps or more")
      ->check(above_zero())
      ->capture_default_str();
  add_run_options(*app, options->run);
  app->callback([options, scene, from, &program] {
    if (scene->empty() && from->empty()) {
      throw InputError("mujoco-run: name a scene, or a log with --from");
    }
    program.code = run_in_mujoco(*options, program.typed);
  });
}

}  // namespace hagfish
