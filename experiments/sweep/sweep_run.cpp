#include "experiments/sweep/sweep_run.hpp"

#include <fmt/format.h>

#include <ctime>
#include <new>

#include "core/log/log_writer.hpp"
#include "core/run/drive.hpp"
#include "experiments/common/failure.hpp"
#include "experiments/common/run_header.hpp"
#include "experiments/judge/run_watch.hpp"
#include "experiments/sweep/sweep.hpp"

namespace hagfish {
namespace {

/// The log of one run, where there is one to be written.
class KeptLog {
 public:
  KeptLog(const std::optional<SweepLog>& log, const ResolvedScene& resolved) : log_(log) {
    if (!log_) return;
    const std::scoped_lock lock(log_->hdf5);
    const LogHeader header = log_header(resolved, sweep_qp, log_->typed);
    writer_ = std::make_unique<LogWriter>(log_->file, true, header, resolved.model, resolved.scene);
  }
  ~KeptLog() {
    if (!writer_) return;
    const std::scoped_lock lock(log_->hdf5);
    writer_.reset();
  }
  KeptLog(const KeptLog&) = delete;
  KeptLog& operator=(const KeptLog&) = delete;

  void write(const StepRecord& record, const Simulation& sim, double time) {
    if (!writer_) return;
    const std::scoped_lock lock(log_->hdf5);
    writer_->write(record, sim, time);
  }
  void finish(const std::string& status, const Simulation& sim) {
    if (!writer_) return;
    const std::scoped_lock lock(log_->hdf5);
    writer_->finish(status, sim);
  }

 private:
  const std::optional<SweepLog>& log_;
  std::unique_ptr<LogWriter> writer_;
};

}  // namespace

double thread_cpu_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::optional<SweepRun> run_for_summary(const ResolvedScene& resolved,
                                        const std::function<bool()>& interrupted,
                                        const std::optional<SweepLog>& log) {
  const Scene& scene = resolved.scene;
  const Model& model = resolved.model;
  KeptLog kept(log, resolved);
  Judge judge(model, scene);
  RunWatch watch(model, scene, judge);
  const double begin = thread_cpu_time();
  std::string outcome = outcome_name(Outcome::ok), message;
  Simulation sim = start(model, scene, sweep_qp);
  double step_begin = thread_cpu_time();
  double cpu_time = step_begin - begin;
  sim.solver.stop_when(
      [&] { return interrupted() || thread_cpu_time() - step_begin > step_cpu_limit; });
  StepRecord record;
  const auto timed = [&](Simulation& of, StepRecord& step) {
    step_begin = thread_cpu_time();
    take_step(model, scene, of, step);
    cpu_time += thread_cpu_time() - step_begin;
  };
  const auto write = [&](const StepRecord& step, const Simulation& of) {
    watch.see(step);
    kept.write(step, of, step_begin - begin);
  };
  try {
    const Status end = drive(scene, timed, sim, record, {write}, interrupted);
    if (interrupted()) return std::nullopt;
    outcome = outcome_name(end.outcome);
    message = end.message;
  } catch (const FileError&) {
    throw;  // so is this of its log
  } catch (const std::bad_alloc&) {
    throw;  // of no meaning for the cell
  } catch (const std::exception& error) {
    outcome = "error";
    message = reason(error);
  }
  watch.see_end(sim);
  const std::string at = fmt::format("{} at step {}", message, sim.step);
  kept.finish(message.empty() ? "complete" : "failed: " + at, sim);
  return SweepRun{judge.summary(outcome, message.empty() ? "" : at), cpu_time};
}

}  // namespace hagfish
