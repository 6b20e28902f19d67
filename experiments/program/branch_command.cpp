#include <fmt/format.h>

#include <limits>

#include "experiments/audit/log_schema.hpp"
#include "experiments/program/idle_settings.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scene_run.hpp"
#include "experiments/program/scene_sense.hpp"

namespace hagfish {
namespace {

struct BranchOptions {
  std::string log;
  double time = std::numeric_limits<double>::infinity();  ///< s
  std::vector<std::string> set;                           ///< KEY=VALUE overrides
  RunOptions run;
};

int branch(const BranchOptions& options, const std::string& typed) {
  const Hdf5Reader h5(options.log);
  SavedRun run = saved_run_at(h5, options.time);
  check_schema(h5, run.model, run.resolved.scene);
  require_named_law(run.resolved.scene, options.log + ": ");
  const double time = time_of(run.sim, run.resolved.scene);
  if (!options.set.empty()) {
    const ResolvedScene resolved =
        read_scene_text(h5.root_text("scene"), options.log + ": scene", options.set);
    run.model = make_hagfish(resolved.specimen, resolved.scene);
    check_sense(resolved, run.model, options.run.force);
    require_settings_act_from(run.sim, resolved.scene, options.set);
    try {
      change_scene(run.model, run.resolved.scene, resolved.scene, run.sim);
    } catch (const std::invalid_argument& error) {
      throw InputError(
          fmt::format("{}: cannot branch at {:g} s: {}", options.log, time, error.what()));
    }
    run.resolved = resolved;
  }
  if (finished(run.sim, run.resolved.scene)) {
    throw InputError(
        fmt::format("{}: cannot branch at {:g} s: the scene has ended by then "
                    "(time.duration = {:g} s; use --time for an earlier branch)",
                    options.log, time, run.resolved.scene.time.duration));
  }
  run.sim.watch = {};  // the branch's own log warns of what it does
  LogHeader header = log_header(run.resolved, run.model, run.qp, typed);
  header.branched_from = fmt::format("{}, step {}, t = {:g} s", options.log, run.sim.step, time);
  LogWriter log(options.run.out, options.run.force, header, run.model, run.resolved.scene);
  if (!options.set.empty()) warn_of_odd_things(run.resolved);
  return take_run(run.model, run.resolved.scene, std::move(run.sim), options.run, log);
}

}  // namespace

void add_branch(Program& program) {
  const auto options = std::make_shared<BranchOptions>();
  CLI::App* branched = program.app.add_subcommand(
      "branch", "go on from a checkpoint of a log, with other settings if wanted");
  branched->add_option("LOG", options->log, "a log, or what a run left of it")->required();
  branched->add_option("--time", options->time,
                       "from the last checkpoint up to this simulated time, s (the last one)");
  branched->add_option("--set", options->set, set_help)->allow_extra_args(false);
  branched->add_option("--out", options->run.out, "log to write")->required();
  add_run_options(*branched, options->run);
  branched->callback([options, &program] { program.code = branch(*options, program.typed); });
}

}  // namespace hagfish
