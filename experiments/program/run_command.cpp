#include <fmt/format.h>

#include <filesystem>

#include "core/input/input_text.hpp"
#include "core/log/build_info.hpp"
#include "core/log/hdf5_error.hpp"
#include "core/log/log_writer.hpp"
#include "experiments/program/commands.hpp"
#include "experiments/program/failure.hpp"
#include "experiments/program/presets.hpp"
#include "experiments/program/progress.hpp"
#include "experiments/program/scene_argument.hpp"
#include "experiments/program/suggestion.hpp"
#include "experiments/program/terminal.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::string scene = default_scene;  ///< a built-in scene's name or a file
  std::string out;                    ///< log to write; SCENE.h5 where empty
  std::string preset;                 ///< settings by name (presets.hpp); none where empty
  std::string qp;                     ///< QP back end; the preset's, or Ipopt, where empty
  std::vector<std::string> set;       ///< KEY=VALUE overrides, after the preset's
  std::string until;                  ///< ends with this phase: time.until; the scene's where empty
  bool force = false;                 ///< replace an existing log
  bool quiet = false;
};

/// How a run ended: the log's status, and the program's exit code.
struct Ending {
  std::string status;
  int code = exit_code::done;
};

/// Steps until the scene is over.
Ending take_steps(const Model& model, const Scene& scene, const std::string& qp, LogWriter& log,
                  Progress& progress) {
  Simulation sim = start(model, scene, qp);
  StepRecord record;
  while (!finished(sim, scene)) {
    if (interrupted()) {
      return {fmt::format("failed: interrupted at step {}", sim.step), exit_code::failed};
    }
    try {
      take_step(model, scene, sim, record);
      log.write(record, progress.elapsed());
      progress.warn(record);
      progress.show(record);
    } catch (const StepError& error) {
      const bool knot =
          error.outcome() == Outcome::never_tied || error.outcome() == Outcome::knot_lost;
      return {fmt::format("failed: {} at step {} (t = {:.4f} s, {})", error.what(), sim.step,
                          time_of(sim, scene), phase_name(record.controller.phase)),
              knot ? exit_code::wrong_knot : exit_code::failed};
    } catch (const std::exception& error) {
      return {fmt::format("failed: {} at step {}", reason(error), sim.step), exit_code::failed};
    }
  }
  return {"complete", exit_code::done};
}

int run(const RunOptions& options, const std::string& typed) {
  const Preset preset = options.preset.empty() ? Preset{"", box_qp_solver_names().front(), {}}
                                               : preset_called(options.preset);
  std::vector<std::string> set = preset.set;
  set.insert(set.end(), options.set.begin(), options.set.end());
  if (!options.until.empty()) set.push_back("time.until=" + options.until);
  const ResolvedScene resolved = scene_argument(options.scene, set);
  const Scene& scene = resolved.scene;
  const Model model = make_hagfish(resolved.specimen, scene);
  const std::string qp = options.qp.empty() ? preset.qp : options.qp;
  const fs::path out =
      options.out.empty() ? fs::path(options.scene).stem().string() + ".h5" : options.out;
  LogHeader header;
  header.command = typed;
  header.scene = scene_to_toml(scene, resolved.specimen);
  header.qp = qp;
  header.libraries = build_libraries();
  header.mjcf = mjcf_files(model, scene.contact.least_arc, scene.time.step);
  LogWriter log(out, options.force, header, model, scene);

  note_signals();
  Progress progress(model, scene, options.quiet);
  const Ending ending = take_steps(model, scene, qp, log, progress);
  progress.end();
  try {
    log.finish(ending.status);
  } catch (const FileError& error) {
    say("hagfish: {}\n", reason(error));
    return exit_code::failed;
  }
  if (ending.code != exit_code::done) {
    say("hagfish: {}\n", printable(out.string() + ": " + ending.status));
    return ending.code;
  }
  if (!options.quiet) {
    say("{}: complete after {:.1f} s\n", out.string(), progress.elapsed());
  }
  return exit_code::done;
}

}  // namespace

void add_run(Program& program) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* run_app = program.app.add_subcommand("run", "run a scene and write its log");
  run_app->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  run_app->add_option("--out", options->out, "log to write (SCENE.h5)");
  run_app->add_option("--preset", options->preset, "settings by name (the scene's, and Ipopt)")
      ->check(one_of(preset_names()));
  run_app->add_option("--qp", options->qp, "QP back end, instead of the preset's")
      ->check(one_of(box_qp_solver_names()));
  run_app->add_option("--set", options->set, set_help)->allow_extra_args(false);
  run_app->add_option("--until", options->until,
                      "stop when this phase has ended: form, tighten, slide, reverse, release");
  run_app->add_flag("--force", options->force, "replace an existing log");
  run_app->add_flag("--quiet", options->quiet, "no progress");
  run_app->callback([options, &program] { program.code = run(*options, program.typed); });
}

}  // namespace hagfish
