#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <filesystem>

#include "core/input/builtin_files.hpp"
#include "core/log/build_info.hpp"
#include "core/log/hdf5_error.hpp"
#include "core/log/log_writer.hpp"
#include "experiments/program/commands.hpp"
#include "experiments/program/presets.hpp"
#include "experiments/program/progress.hpp"
#include "experiments/program/scene_argument.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

// A signal handler can reach nothing else.
volatile std::sig_atomic_t interrupted = 0;
void interrupt(int /*signal*/) { interrupted = 1; }

constexpr int run_failed = 1;
constexpr int wrong_knot = 3;

/// How a run ended: the log's status, and the program's exit code.
struct Ending {
  std::string status;
  int code = 0;
};

/// Steps until the scene is over.
Ending take_steps(const Model& model, const Scene& scene, const std::string& qp, LogWriter& log,
                  Progress& progress) {
  Simulation sim = start(model, scene, qp);
  StepRecord record;
  while (!finished(sim, scene)) {
    if (interrupted != 0) {
      return {fmt::format("failed: interrupted at step {}", sim.step), run_failed};
    }
    try {
      take_step(model, scene, sim, record);
      log.write(record, progress.elapsed());
      progress.warn(record);
      progress.show(record);
    } catch (const FileError&) {
      throw;  // the log itself cannot be written
    } catch (const StepError& error) {
      const bool knot =
          error.outcome() == Outcome::never_tied || error.outcome() == Outcome::knot_lost;
      return {fmt::format("failed: {} at step {} (t = {:.4f} s, {})", error.what(), sim.step,
                          time_of(sim, scene), phase_name(record.controller.phase)),
              knot ? wrong_knot : run_failed};
    } catch (const std::exception& error) {
      return {fmt::format("failed: {} at step {}", error.what(), sim.step), run_failed};
    }
  }
  return {"complete", 0};
}

}  // namespace

int run(const RunOptions& options) {
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
  header.command = options.command;
  header.scene = scene_to_toml(scene, resolved.specimen);
  header.qp = qp;
  header.libraries = build_libraries();
  header.mjcf = mjcf_files(model, scene.contact.least_arc, scene.time.step);
  LogWriter log(out, options.force, header, model, scene);

  interrupted = 0;
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  Progress progress(model, scene, options.quiet);
  const Ending ending = take_steps(model, scene, qp, log, progress);
  progress.end();
  log.finish(ending.status);
  if (ending.code != 0) {
    fmt::print(stderr, "hagfish: {}: {}\n", out.string(), ending.status);
    return ending.code;
  }
  if (!options.quiet) {
    fmt::print(stderr, "{}: complete after {:.1f} s\n", out.string(), progress.elapsed());
  }
  return 0;
}

int list_scenes() {
  for (const std::string_view name : builtin_scene_names()) {
    const auto text = builtin_file(fmt::format("{}.toml", name));
    const ResolvedScene resolved =
        read_scene_text(std::string(*text), std::string(name) + " (built in)");
    fmt::print("{:<20} {}\n", name, resolved.scene.title);
  }
  return 0;
}

}  // namespace hagfish
