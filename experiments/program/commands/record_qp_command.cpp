#include <fmt/format.h>

#include <cstdio>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/run/drive.hpp"
#include "experiments/benchmarks/qp_set.hpp"
#include "experiments/benchmarks/step_qp.hpp"
#include "experiments/common/progress.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/common/scene_sense.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

struct RecordQpOptions {
  std::string scene = default_scene;
  std::string out;               ///< HDF5 file to write
  std::string qp = "ipopt";      ///< QP back end of the run
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  int every = 1;                 ///< steps from one that is recorded to the next
  bool primal = false;           ///< as {H, g, G, e, C, d} instead of {A, b, l, u}
  bool force = false;            ///< replace an existing file
  bool quiet = false;
};

/// Takes the steps of a run and keeps their QPs.
class Recorder {
 public:
  Recorder(const RecordQpOptions& options, const Model& model, const Scene& scene, QpSetWriter& set)
      : options_(options), model_(model), scene_(scene), set_(set) {}

  /// The QP of a step, if it had one; `warm` as the step found it.
  void take(const StepRecord& record, const WarmStart& warm) {
    if (!has_qp(record.solution) || record.step % options_.every != 0) {
      return;
    }
    StoredQp qp;
    qp.start = kept_multipliers(record.solution.rows, warm);
    if (!options_.primal) {
      qp.box = whole_dual(model_, record.after.observation.kin, record.solution.system,
                          record.solution.rows);
    } else {
      if (at_cap(record.solution)) {
        ++left_out_;
        return;
      }
      qp.primal = to_primal(model_, scene_, record);
    }
    // Consecutive steps share a number.
    sequence_ += set_.size() > 0 && record.step != last_ + 1 ? 1 : 0;
    last_ = record.step;
    qp.sequence = sequence_;
    set_.append(qp, record.step);
  }

  int left_out() const { return left_out_; }

 private:
  const RecordQpOptions& options_;
  const Model& model_;
  const Scene& scene_;
  QpSetWriter& set_;
  std::int64_t sequence_ = 0, last_ = 0;
  int left_out_ = 0;
};

int record_qp(const RecordQpOptions& options, const std::string& typed) {
  const ResolvedScene resolved = scene_argument(options.scene, options.set);
  const Scene& scene = resolved.scene;
  if (scene.time.rule != TimeRule::euler) {
    throw InputError("time.rule = midpoint: QPs can only be recorded by \"euler\"");
  }
  const Model& model = resolved.model;
  check_sense(resolved, options.force);
  QpSetWriter set(options.out, options.force, typed, scene_to_toml(scene, resolved.specimen));
  warn_of_odd_things(resolved);
  Recorder recorder(options, model, scene, set);
  Progress progress(model, scene, options.quiet);
  note_signals();
  std::string failure;
  Simulation sim = start(model, scene, options.qp);
  sim.solver.stop_when(interrupted);
  WarmStart warm;
  StepRecord record;
  const auto take = [&](Simulation& of, StepRecord& step) {
    warm = of.solver.warm;
    take_step(model, scene, of, step);
  };
  const auto see = [&](const StepRecord& step, const Simulation&) {
    recorder.take(step, warm);
    progress.show(step);
  };
  if (const Status end = drive(scene, take, sim, record, {see}, interrupted); !end.ok()) {
    failure = fmt::format("{} at step {} (t = {:.4f} s)",
                          end.outcome == Outcome::stopped ? "interrupted" : end.message, sim.step,
                          time_of(sim, scene));
  }
  progress.end();
  set.finish();
  fmt::print("{}: {} QPs of {} steps{}\n", printable(options.out), set.size(), sim.step,
             recorder.left_out() == 0
                 ? ""
                 : fmt::format("; {} left out, as a row is at its controller.cap, which "
                               "{{H, g, G, e, C, d}} cannot express",
                               recorder.left_out()));
  if (!failure.empty()) {
    std::fflush(stdout);
    say("hagfish: {}: the run failed: {}\n", printable(options.out), failure);
    return exit_code::failed;
  }
  return exit_code::done;
}

}  // namespace

void add_record_qp(Program& program) {
  const auto options = std::make_shared<RecordQpOptions>();
  CLI::App* record = program.app.add_subcommand("record-qp", "run a scene and save its QPs");
  record->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  record->add_option("--out", options->out, "HDF5 file to write")->required();
  record->add_option("--qp", options->qp, "QP back end of the run")
      ->check(one_of(box_qp_solver_names()))
      ->capture_default_str();
  record->add_option("--set", options->set, set_help)->allow_extra_args(false);
  record->add_option("--every", options->every, "steps from one saved to the next")
      ->check(above_zero())
      ->capture_default_str();
  record->add_flag("--primal", options->primal, "save {H, g, G, e, C, d}, not {A, b, l, u}");
  record->add_flag("--force", options->force, "replace an existing file");
  record->add_flag("--quiet", options->quiet, "no progress");
  record->callback([options, &program] { program.code = record_qp(*options, program.typed); });
}

}  // namespace hagfish
