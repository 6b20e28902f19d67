
#include <filesystem>

#include "core/input/input_text.hpp"
#include "core/log/build_info.hpp"
#include "core/log/reading/logged_run.hpp"
#include "experiments/common/idle_settings.hpp"
#include "experiments/common/presets.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/common/scene_sense.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scene_run.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

struct NewRunOptions {
  std::string scene = default_scene;  ///< a built-in scene's name or a file
  std::string preset;                 ///< settings by name (presets.hpp); none where empty
  std::string qp;                     ///< QP back end; the preset's where empty
  std::vector<std::string> set;       ///< KEY=VALUE overrides, after the preset's
  std::string until;                  ///< ends with this phase: time.until; the scene's where empty
  std::string level = log_level_name(LogLevel::full);  ///< how much is logged
  std::string resume;  ///< log of a run to go on with, instead of all these
  RunOptions run;
};

int run_anew(NewRunOptions options, const std::string& typed) {
  const Preset preset = options.preset.empty() ? Preset{} : preset_called(options.preset);
  std::vector<std::string> set = preset.set;
  set.insert(set.end(), options.set.begin(), options.set.end());
  if (!options.until.empty()) set.push_back("time.until=" + options.until);
  const ResolvedScene resolved = scene_argument(options.scene, set);
  const Scene& scene = resolved.scene;
  const Model& model = resolved.model;
  check_sense(resolved, options.run.force);
  require_settings_act(scene, options.set);
  const std::string qp = options.qp.empty() ? preset.qp : options.qp;
  if (options.run.out.empty()) {
    options.run.out = fs::path(options.scene).stem().string() + ".h5";
  }
  LogHeader header = log_header(resolved, qp, typed);
  header.level = log_level_called(options.level);
  LogWriter log(options.run.out, options.run.force, header, model, scene);
  warn_of_odd_things(resolved);
  return take_run(model, scene, start(model, scene, qp), options.run, log);
}

/// FILE of FILE.part, by which a run is known.
std::string without_part(const std::string& file) {
  const fs::path path(file);
  return path.extension() == ".part" ? fs::path(path).replace_extension().string() : file;
}

int resume(NewRunOptions options, const std::string& typed) {
  options.run.out = without_part(options.resume);
  const std::string part = options.run.out + ".part";
  // Read before anything is renamed: what cannot be gone on with stays as it is.
  const std::string part_or_whole = fs::exists(part) ? part : options.run.out;
  const Hdf5Reader h5(part_or_whole);
  const LoggedRun run = logged_run(h5);
  if (h5.root_text("status") == "complete") throw FileError(h5.file() + ": the run is complete");
  const Scene& scene = run.resolved.scene;
  LogHeader header = log_header(run.resolved, run.qp, typed);
  header.level = level_of(h5);
  header.past = run.past;
  if (!run.past.empty()) header.branched_from = h5.root_text("branched_from");
  const std::string revision = h5.root_text("git_revision");
  LogWriter log(options.run.out, true, header, run.resolved.model, scene, run.steps);
  if (!options.run.quiet) {
    say("{}: its scene is run again from the start; what there is, {:g} s, stays until then\n",
        printable(part_or_whole), static_cast<double>(run.steps) * scene.time.step);
  }
  if (revision != build_revision()) {
    say("hagfish: {}: begun by revision {}, made again by {}: it may come otherwise\n",
        printable(options.run.out), printable(revision), build_revision());
  }
  return take_run(run.resolved.model, scene, begin_again(run), options.run, log);
}

}  // namespace

void add_run(Program& program) {
  const auto options = std::make_shared<NewRunOptions>();
  CLI::App* run = program.app.add_subcommand("run", "run a scene and write its log");
  std::vector<CLI::Option*> of_new;
  of_new.push_back(run->add_option("SCENE", options->scene, scene_help)->capture_default_str());
  of_new.push_back(run->add_option("--out", options->run.out, "log to write (SCENE.h5)"));
  of_new.push_back(run->add_option("--preset", options->preset, "settings by name")
                       ->check(one_of(preset_names())));
  of_new.push_back(run->add_option("--qp", options->qp, "QP back end, instead of the preset's")
                       ->check(one_of(box_qp_solver_names())));
  of_new.push_back(run->add_option("--set", options->set, set_help)->allow_extra_args(false));
  of_new.push_back(run->add_option(
      "--until", options->until,
      "stop when this phase has ended: form, tighten, slide, pull, reverse, release"));
  of_new.push_back(run->add_option("--log", options->level,
                                   "how much is logged: summary, frames (figures, tables, films) "
                                   "or full (audit)")
                       ->check(one_of(log_level_names()))
                       ->capture_default_str());
  CLI::Option* resumed =
      run->add_option("--resume", options->resume,
                      "make the unfinished run of this log, F.h5.part or F.h5, to its end");
  for (CLI::Option* option : of_new) {
    resumed->excludes(option);
  }
  add_run_options(*run, options->run);
  run->callback([options, &program] {
    program.code = options->resume.empty() ? run_anew(*options, program.typed)
                                           : resume(*options, program.typed);
  });
}

}  // namespace hagfish
