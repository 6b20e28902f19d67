#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "core/input/input_text.hpp"
#include "experiments/benchmarks/qp_table.hpp"
#include "experiments/common/csv.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

struct QpOptions {
  std::string set;                     ///< HDF5 file of QPs
  std::vector<std::string> back_ends;  ///< those of measured_back_ends() where empty
  std::vector<double> tolerances;      ///< of Ipopt, each in turn; its own where empty
  int repeat = 3;                      ///< times that each QP is solved
  std::string csv;                     ///< table as a file; none where empty
  bool force = false;
};

std::vector<BackEnd> chosen(const QpOptions& options) {
  const std::vector<std::string> names =
      options.back_ends.empty() ? measured_back_ends() : options.back_ends;
  std::vector<BackEnd> back_ends;
  for (const std::string& name : names) {
    if (options.tolerances.empty() || !name.starts_with("ipopt")) {
      back_ends.push_back({name});
      continue;
    }
    for (const double tolerance : options.tolerances) {
      back_ends.push_back({name, tolerance});
    }
  }
  return back_ends;
}

/// A number, or nothing where it does not apply.
std::string number(const char* form, double value, bool applies = true) {
  return applies ? fmt::format(fmt::runtime(form), value) : "";
}

CsvTable csv_of(const QpReport& report) {
  CsvTable table{{"back_end", "tolerance", "start", "qps", "median_s", "p99_s", "max_s",
                  "iterations", "kkt", "error_norm", "error_norm_relative", "error_entry",
                  "error_entry_relative", "without_reference", "failures"}};
  for (const Performance& row : report.rows) {
    const bool entries = report.primal > 0;
    const double tolerance = row.back_end.tolerance;
    table.push_back({row.back_end.name, number("{:g}", tolerance, !std::isnan(tolerance)),
                     row.warm ? "warm" : "cold", std::to_string(row.time.size()),
                     number("{:.9g}", quantile(row.time, 0.5)),
                     number("{:.9g}", quantile(row.time, upper_quantile)),
                     number("{:.9g}", quantile(row.time, 1)), std::to_string(row.iterations),
                     number("{:.6g}", row.kkt), number("{:.6g}", row.velocity.norm),
                     number("{:.6g}", row.velocity.relative),
                     number("{:.6g}", row.velocity.largest, entries),
                     number("{:.6g}", row.velocity.largest_relative, entries),
                     std::to_string(report.without_reference), std::to_string(row.failures)});
  }
  return table;
}

int qp(const QpOptions& options) {
  const QpSetReader set(options.set);
  std::optional<TextFile> csv;
  if (!options.csv.empty()) {
    csv.emplace(options.csv, options.force);
  }
  const QpReport report = measure(set, chosen(options), options.repeat);
  print_qp_heading(printable(options.set), report, options.repeat);
  print_qp_table(report);
  if (!options.csv.empty()) {
    csv->write(csv_text(csv_of(report)));
  }
  int failures = 0;
  for (const Performance& row : report.rows) {
    failures += row.failures;
  }
  if (failures == 0) {
    return exit_code::done;
  }
  std::fflush(stdout);
  for (const std::string& failure : report.failures) {
    say("hagfish: {}\n", printable(options.set + ": " + failure));
  }
  if (const auto told = static_cast<int>(report.failures.size()); failures > told) {
    say("hagfish: {}: and {} more failures\n", printable(options.set), failures - told);
  }
  return exit_code::failed;
}

}  // namespace

void add_qp(Program& program) {
  const auto options = std::make_shared<QpOptions>();
  CLI::App* qp_app = program.app.add_subcommand(
      "qp", "solve a set of QPs with each back end, cold and warm; exits 1 where one fails");
  qp_app->add_option("SET", options->set, "HDF5 file of QPs")->required();
  qp_app->add_option("--backend", options->back_ends, "repeatable (all)")
      ->check(one_of(measured_back_ends()))
      ->allow_extra_args(false);
  qp_app
      ->add_option("--tolerance", options->tolerances,
                   "where Ipopt stops, repeatable: measures each (1e-4; unpolished 1e-9)")
      ->check(above_zero())
      ->allow_extra_args(false);
  qp_app->add_option("--repeat", options->repeat, "times that each QP is solved")
      ->check(above_zero())
      ->capture_default_str();
  qp_app->add_option("--csv", options->csv, "file for the table");
  qp_app->add_flag("--force", options->force, force_help);
  qp_app->callback([options, &program] { program.code = qp(*options); });
}

}  // namespace hagfish
