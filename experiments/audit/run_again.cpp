#include "experiments/audit/compare_logs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <filesystem>

#include "core/log/build_info.hpp"
#include "core/log/log_writer.hpp"
#include "core/log/reading/logged_run.hpp"
#include "core/run/drive.hpp"
#include "experiments/common/run_header.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

/// Differences that are told.
constexpr std::size_t most_told = 5;

/// Whether this build made the log, on a machine of this kind.
bool is_of_this_build(const Hdf5Reader& h5) {
  return h5.root_text("git_revision") == build_revision() &&
         h5.root_text("compiler") == build_compiler() && h5.root_text("cpu") == cpu_name();
}

/// A log in a folder of its own, which goes with it.
class Rerun {
 public:
  Rerun(const LoggedRun& run, std::int64_t steps) {
    std::string name = (fs::temp_directory_path() / "hagfish-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw FileError(name + ": cannot be made: " + std::strerror(errno));
    }
    folder_ = name;
    const Scene& scene = run.resolved.scene;
    LogHeader header = log_header(run.resolved, run.qp, "");
    header.past = run.past;
    if (!run.past.empty()) header.branched_from = "another log";
    LogWriter writer(file(), false, header, run.resolved.model, scene);
    Simulation sim = begin_again(run);
    const std::int64_t end = sim.step + steps;
    StepRecord record;
    const auto write = [&writer](const StepRecord& step, const Simulation& at) {
      writer.write(step, at, 0);
    };
    const Status ending = drive(run.resolved.model, scene, sim, record, {write},
                                [&sim, end] { return sim.step == end; });
    if (ending.outcome != Outcome::stopped) failure_ = ending.message;
    complete_ = finished(sim, scene);
    writer.finish("complete", sim);
  }
  ~Rerun() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Rerun(const Rerun&) = delete;
  Rerun& operator=(const Rerun&) = delete;

  fs::path file() const { return folder_ / "again.h5"; }
  /// Why it ended early; empty where it did not.
  const std::string& failure() const { return failure_; }
  /// Whether its scene is over.
  bool complete() const { return complete_; }

 private:
  fs::path folder_;
  std::string failure_;
  bool complete_ = false;
};

/// What is otherwise in the run made again, and how far it is not.
LogComparison compared(const LogContents& log) {
  const auto steps = static_cast<std::int64_t>(log.h5.shape("/steps/time").at(0));
  const Rerun rerun(logged_run(log.h5), steps);
  LogComparison compared = compare_logs(log, rerun.file(), is_of_this_build(log.h5));
  std::vector<std::string>& otherwise = compared.differences;
  if (!rerun.failure().empty()) otherwise.insert(otherwise.begin(), "fails: " + rerun.failure());
  if (log.h5.root_text("status") == "complete" && !rerun.complete()) {
    otherwise.emplace_back("its scene is not over where the log ends");
  }
  return compared;
}

}  // namespace

Finding audit_again(const LogContents& log) try {
  if (const std::string why = why_not_again(log.h5); !why.empty()) {
    return {"again", true, "not run again: " + why, "", "", ""};
  }
  auto [otherwise, reach] = compared(log);
  const std::size_t count = otherwise.size();
  std::string text = "all of it comes again " + reach;
  if (count > 0) {
    if (count > most_told) otherwise.resize(most_told);
    text = fmt::format("comes otherwise: {}", fmt::join(otherwise, "; "));
    if (count > most_told) text += fmt::format("; and {} more", count - most_told);
  }
  return judged({"again", static_cast<double>(count), 0, "differences"}, text);
} catch (const std::runtime_error& error) {  // of a file, or of a step before a branch
  return {
      "again", false, fmt::format("cannot be run again: {} (--fast leaves it out)", error.what()),
      "",      "",    ""};
}

}  // namespace hagfish
