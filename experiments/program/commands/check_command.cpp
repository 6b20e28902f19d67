#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

#include "core/input/input_text.hpp"
#include "experiments/audit/compare_logs.hpp"
#include "experiments/common/csv.hpp"
#include "experiments/common/failure.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

struct CheckOptions {
  std::vector<std::string> logs;
  std::string csv;    ///< findings as a file; none where empty
  bool fast = false;  ///< does not make their runs again
  bool all = false;   ///< shows all findings that passed
  bool force = false;
};

/// Lines of a log where not all are asked for. A failure is shown whatever their number.
constexpr std::ptrdiff_t most_lines = 10;

/// Of what passed, the first findings and the last one, which is of the run made again.
void show(const std::vector<Finding>& findings, bool all) {
  const bool fits = all || std::ssize(findings) <= most_lines;
  // The last two lines are the last finding, and what tells of those that are left out.
  const auto first = most_lines - 2 - std::ranges::count(findings, false, &Finding::passed);
  std::ptrdiff_t passed = 0, left_out = 0;
  for (const Finding& f : findings) {
    if (f.passed && !fits && passed++ >= first && (first < 0 || &f != &findings.back())) {
      ++left_out;
      continue;
    }
    fmt::print("{:<4} {:<24} {}\n", f.passed ? "ok" : "FAIL", f.name, printable(f.text));
  }
  if (left_out > 0) fmt::print("{:<4} {} more checks; --all shows them\n", "ok", left_out);
}

/// Audits one log; its findings become rows of `table`. Returns an exit code.
int check_log(const std::string& file, const CheckOptions& options, CsvTable& table) {
  const LogContents log(file);
  std::vector<Finding> findings = audit(log);
  if (!options.fast) findings.push_back(audit_again(log));
  show(findings, options.all);
  std::vector<std::string> unmet;
  for (const Finding& f : findings) {
    table.push_back({file, f.name, printable(f.value), f.bound, f.unit, f.passed ? "yes" : "no"});
    if (!f.passed) unmet.push_back(f.name);
  }
  if (unmet.empty()) {
    return exit_code::done;
  }
  if (std::fflush(stdout) != 0) throw std::runtime_error("standard output cannot be written");
  say("hagfish: {}: check failed: {}\n", printable(file), fmt::join(unmet, ", "));
  return exit_code::failed;
}

int check(const CheckOptions& options) {
  std::optional<TextFile> csv;
  if (!options.csv.empty()) csv.emplace(options.csv, options.force);
  CsvTable table{{"log", "criterion", "value", "bound", "unit", "met"}};
  int code = exit_code::done;
  for (const std::string& file : options.logs) {
    if (options.logs.size() > 1) {
      fmt::print("{}{}:\n", &file == options.logs.data() ? "" : "\n", printable(file));
    }
    try {
      code = std::max(code, check_log(file, options, table));
    } catch (const std::exception& error) {
      // One log that cannot be read does not lose the others.
      if (!is_bad_input(error)) throw;
      std::fflush(stdout);
      say("hagfish: {}\n", reason(error));
      code = exit_code::bad_input;
    }
  }
  if (csv) csv->write(csv_text(table));
  return code;
}

}  // namespace

void add_check(Program& program) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* check_app =
      program.app.add_subcommand("check", "audit logs; exits 1 naming what fails");
  check_app->add_option("LOG", options->logs, "log files")->required();
  check_app->add_option("--csv", options->csv,
                        "file for the findings: log, criterion, value, bound, unit, met");
  check_app->add_flag("--fast", options->fast,
                      "judge the physics alone: do not make the run again and compare all of it");
  check_app->add_flag("--all", options->all, "show every check, not ten lines a log");
  check_app->add_flag("--force", options->force, force_help);
  check_app->callback([options, &program] { program.code = check(*options); });
}

}  // namespace hagfish
