#include "experiments/sweep/sweep.hpp"

#include <fmt/format.h>

#include <chrono>
#include <mutex>
#include <vector>

#include "core/input/input_error.hpp"
#include "experiments/common/cpu_time.hpp"
#include "experiments/common/in_parallel.hpp"
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

/// What threads share.
class Sweep {
 public:
  Sweep(const Grid& grid, const SweepOptions& options, SweepTable& table, SweepOutcome& outcome)
      : grid_(grid), options_(options), table_(table), outcome_(outcome) {}

  /// Makes the row of a cell; none where the sweep is interrupted.
  void run_cell(std::size_t cell) {
    if (options_.interrupted()) return;
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

 private:
  fs::path log_of(std::size_t cell) const {
    return options_.folder / "logs" / fmt::format("{}.h5", cell);
  }

  std::optional<SweepRun> run(std::size_t cell, const ResolvedScene& resolved, bool keep) {
    std::optional<SweepLog> log;
    if (keep) log.emplace(SweepLog{log_of(cell), options_.typed, hdf5_});
    return run_for_summary(resolved, options_.interrupted, log);
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
  std::mutex table_mutex_, hdf5_;
};

}  // namespace

SweepOutcome run_sweep(const Grid& grid, const SweepOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const double cpu_begin = cpu_time();
  claim_folder(options.folder, grid_identity(grid));
  if (grid.keep != KeptLogs::none) fs::create_directories(options.folder / "logs");
  SweepTable table(options.folder, options.part, grid.size(), heading_of(grid));
  const std::vector<std::size_t> missing = table.missing();
  SweepOutcome outcome;
  outcome.cells = table.cell_count();
  outcome.before = outcome.cells - missing.size();
  Sweep sweep(grid, options, table, outcome);
  in_parallel(static_cast<int>(missing.size()), options.threads,
              [&](int k) { sweep.run_cell(missing[k]); });
  if (outcome.whole()) table.finish();
  outcome.wall_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  outcome.cpu = cpu_time() - cpu_begin;
  return outcome;
}

}  // namespace hagfish
