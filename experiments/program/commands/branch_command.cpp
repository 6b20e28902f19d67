#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/input/input_text.hpp"
#include "core/log/reading/logged_run.hpp"
#include "experiments/common/idle_settings.hpp"
#include "experiments/common/scene_sense.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scene_run.hpp"

namespace hagfish {
namespace {

struct BranchOptions {
  std::string log;
  double time = std::numeric_limits<double>::infinity();  ///< s
  std::vector<std::string> set;                           ///< KEY=VALUE overrides
  RunOptions run;
};

/// The last frame up to `time` (s); times of steps are known to `slack`.
std::size_t frame_up_to(const Hdf5Reader& h5, double time, double slack) {
  const std::vector<double> times = h5.doubles("/trajectory/time");
  const auto behind = std::ranges::upper_bound(times, time + slack) - times.begin();
  if (behind == 0) {
    throw FileError(fmt::format("{}: begins at {:g} s", h5.file(), times.at(0)));
  }
  return static_cast<std::size_t>(behind - 1);
}

/// Tells where the run made again is not at the frame that its log has, as by another program.
void tell_other_state(const Hdf5Reader& h5, std::size_t frame, const Eigen::VectorXd& q) {
  if (level_of(h5) == LogLevel::summary) return;
  constexpr double rounding = 1e-9;  // cm, rad: logs of frames alone have multiples of 2^-32
  const Hdf5Reader::Rows logged = h5.rows("/trajectory/q");
  const auto row = static_cast<Eigen::Index>(frame);
  const bool fits = row < logged.rows() && logged.cols() == q.size();
  const double off = fits ? (logged.row(row).transpose() - q).lpNorm<Eigen::Infinity>() : INFINITY;
  if (off <= rounding) return;
  say("hagfish: {}: made by revision {}; run again by this one it comes there otherwise, by {:.2g} "
      "cm or rad, and the branch begins from that\n",
      printable(h5.file()), printable(h5.root_text("git_revision")), off);
}

int branch_off(const BranchOptions& options, const std::string& typed) {
  const Hdf5Reader h5(options.log);
  const LoggedRun run = logged_run(h5);
  // Half a step of slack: the time of a step is a product and may come out larger by rounding.
  const std::size_t frame = frame_up_to(h5, options.time, 0.5 * run.resolved.scene.time.step);
  const std::int64_t step = h5.integers("/trajectory/step").at(frame);
  Simulation sim = begin_again(run);
  go_on_to(step, run.resolved.model, run.resolved.scene, sim);
  const Eigen::VectorXd q = sim.now.state.q;
  const double time = time_of(sim, run.resolved.scene);
  const ResolvedScene resolved = logged_scene(h5, options.set);
  const Model& model = resolved.model;
  if (!options.set.empty()) {
    check_sense(resolved, options.run.force);
    require_settings_act_from(sim, resolved.scene, options.set);
  }
  try {
    branch(run.resolved, resolved, sim);
  } catch (const std::invalid_argument& error) {
    throw InputError(
        fmt::format("{}: cannot branch at {:g} s: {}", options.log, time, error.what()));
  }
  if (finished(sim, resolved.scene)) {
    throw InputError(
        fmt::format("{}: cannot branch at {:g} s: the scene has ended by then "
                    "(time.duration = {:g} s; use --time for an earlier branch)",
                    options.log, time, resolved.scene.time.duration));
  }
  LogHeader header = log_header(resolved, run.qp, typed);
  header.branched_from = fmt::format("{}, step {}, t = {:g} s", options.log, step, time);
  header.past = run.past;
  header.past.push_back({h5.root_text("scene"), step});
  LogWriter log(options.run.out, options.run.force, header, model, resolved.scene);
  tell_other_state(h5, frame, q);
  if (!options.set.empty()) warn_of_odd_things(resolved);
  return take_run(model, resolved.scene, std::move(sim), options.run, log);
}

}  // namespace

void add_branch(Program& program) {
  const auto options = std::make_shared<BranchOptions>();
  CLI::App* branched = program.app.add_subcommand(
      "branch", "go on from a frame of a log, with other settings if wanted");
  branched->add_option("LOG", options->log, "a log, or what a run left of it")->required();
  branched->add_option("--time", options->time,
                       "from the last frame up to this simulated time, s (the last one)");
  branched->add_option("--set", options->set, set_help)->allow_extra_args(false);
  branched->add_option("--out", options->run.out, "log to write")->required();
  add_run_options(*branched, options->run);
  branched->callback([options, &program] { program.code = branch_off(*options, program.typed); });
}

}  // namespace hagfish
