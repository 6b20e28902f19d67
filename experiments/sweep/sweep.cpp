#include "experiments/sweep/sweep.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/input/input_error.hpp"
#include "experiments/sweep/sweep_run.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> heading_of(const Grid& grid) {
  std::vector<std::string> heading{"cell"};
  const std::vector<std::string> keys = grid.keys();
  heading.insert(heading.end(), keys.begin(), keys.end());
  for (const auto& [name, value] : RunSummary{}.fields()) heading.push_back(name);
  return heading;
}

double process_cpu_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// What threads share.
class Sweep {
 public:
  Sweep(const Grid& grid, const SweepOptions& options, SweepTable& table, SweepOutcome& outcome)
      : grid_(grid),
        options_(options),
        table_(table),
        outcome_(outcome),
        missing_(table.missing()) {}

  /// One thread takes cells until there are none, or the sweep is to end.
  void work() {
    try {
      for (std::size_t k = next_++; k < missing_.size() && !ending(); k = next_++) {
        run_cell(missing_[k]);
      }
    } catch (...) {
      const std::scoped_lock lock(table_mutex_);
      if (!error_) error_ = std::current_exception();
      failed_ = true;
    }
  }

  /// After all threads: throws what ended one of them.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  bool ending() const { return failed_ || options_.interrupted(); }

  fs::path log_of(std::size_t cell) const {
    return options_.folder / "logs" / fmt::format("{}.h5", cell);
  }

  std::optional<SweepRun> run(std::size_t cell, const ResolvedScene& resolved, bool keep) {
    std::optional<SweepLog> log;
    if (keep) log.emplace(SweepLog{log_of(cell), options_.typed, hdf5_});
    return run_for_summary(
        resolved, [this] { return ending(); }, log);
  }

  void run_cell(std::size_t cell) {
    const std::vector<std::size_t> places = grid_.places(cell);
    std::optional<SweepRun> done;
    try {
      const ResolvedScene resolved = scene_at(grid_, places);
      done = run(cell, resolved, grid_.keep == KeptLogs::all);
      // A run repeats to the last bit: the log of one that fails is made by a second one, so that
      // the others need none.
      const auto failed = [](const RunSummary& s) {
        return !s.message.empty() || !s.unmet.empty();
      };
      const bool again = done && grid_.keep == KeptLogs::failed && failed(done->summary);
      if (again && !run(cell, resolved, true)) return;
    } catch (const InputError& error) {
      done.emplace();
      done->summary.outcome = "refused";
      done->summary.message = error.what();
    }
    if (done) add(cell, grid_.values(places), *done);
  }

  void add(std::size_t cell, std::vector<std::string> fields, const SweepRun& run) {
    for (const auto& [name, value] : run.summary.fields()) fields.push_back(value);
    const std::scoped_lock lock(table_mutex_);
    table_.add(cell, fields, run.cpu_time);
    ++outcome_.now;
    outcome_.simulated += run.cpu_time;
    options_.done(outcome_.before + outcome_.now);
  }

  const Grid& grid_;
  const SweepOptions& options_;
  SweepTable& table_;
  SweepOutcome& outcome_;
  std::vector<std::size_t> missing_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex table_mutex_, hdf5_;
  std::exception_ptr error_;
};

}  // namespace

SweepOutcome run_sweep(const Grid& grid, const SweepOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const double cpu_begin = process_cpu_time();
  claim_folder(options.folder, grid_identity(grid));
  if (grid.keep != KeptLogs::none) fs::create_directories(options.folder / "logs");
  SweepTable table(options.folder, options.part, grid.size(), heading_of(grid));
  SweepOutcome outcome;
  outcome.cells = table.cell_count();
  outcome.before = outcome.cells - table.missing().size();
  Sweep sweep(grid, options, table, outcome);
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < options.threads; ++t) threads.emplace_back([&sweep] { sweep.work(); });
  }
  sweep.rethrow();
  if (outcome.whole()) table.finish();
  outcome.wall_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  outcome.cpu = process_cpu_time() - cpu_begin;
  return outcome;
}

}  // namespace hagfish
